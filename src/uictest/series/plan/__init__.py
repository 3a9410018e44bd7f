"""What a series file says: its stops and the criteria that they are judged by."""
