from .files import read as read, write as write
