from .survey import LogSurvey as LogSurvey
