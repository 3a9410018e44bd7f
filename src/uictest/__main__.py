"""The command as `python -m uictest`, where the program is not on the path."""

from uictest.cli import main

if __name__ == "__main__":
    main()
