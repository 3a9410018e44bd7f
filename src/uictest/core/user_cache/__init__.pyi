from .files import read as read, write as write
from .turns import turn as turn
