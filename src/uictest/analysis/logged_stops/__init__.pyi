from .survey import LogSurvey as LogSurvey
from .unpaired import compare_logs as compare_logs, logs_form as logs_form
