from .files import read as read, turn as turn, write as write
