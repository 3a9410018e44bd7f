from .survey import LogSurvey as LogSurvey, stops_table as stops_table
from .unpaired import compare_logs as compare_logs, logs_form as logs_form
