"""Start a module of the package as if on Windows, as far as Linux can play it: its own code finds no POSIX.

    python tests/without_posix.py MODULE ARGUMENT...

Only modules of the package are restricted: the standard library and other packages have branches of their own
for Windows. Child processes of the same interpreter are started by this file as well.
"""

import builtins
import contextlib
import os
import runpy
import stat
import subprocess
import sys
from functools import wraps
from pathlib import Path
from types import ModuleType

MISSING = ("fcntl", "grp", "posix", "pwd", "resource", "syslog", "termios", "tty")
WITHOUT = {
    "os": """
        EX_IOERR EX_USAGE O_CLOEXEC O_DIRECTORY O_NOFOLLOW O_NONBLOCK O_SYNC O_TMPFILE WNOHANG chown chroot
        confstr environb fchdir fchmod fchown fork forkpty fwalk get_blocking getegid geteuid getgid
        getgroups getloadavg getpgid getsid getuid getxattr killpg lchown lockf memfd_create mkfifo mknod
        nice openpty pidfd_open pipe2 posix_fadvise posix_fallocate posix_spawn pread pwrite readv
        register_at_fork sched_getaffinity sched_setaffinity sendfile set_blocking setgid setpgid
        setpriority setsid setuid setxattr statvfs sync sysconf uname wait wait4 waitid writev
    """,
    "signal": """
        ITIMER_REAL SIGALRM SIGBUS SIGCHLD SIGCONT SIGHUP SIGKILL SIGPIPE SIGQUIT SIGSTOP SIGUSR1 SIGUSR2
        SIGXCPU SIGXFSZ alarm getitimer pause pthread_kill pthread_sigmask setitimer siginterrupt sigwait
    """,
    "socket": "AF_UNIX recv_fds send_fds",
    "select": "epoll poll",
    "time": "clock_gettime pthread_getcpuclockid tzset",
    "mmap": "MADV_DONTFORK MAP_ANONYMOUS MAP_PRIVATE MAP_SHARED PROT_READ PROT_WRITE",
}
"""What these modules lack on Windows; `os.set_blocking` came to it with Python 3.12."""
POSIX_OPTIONS = ("pass_fds", "preexec_fn", "start_new_session", "umask", "user", "group", "process_group")
REFUSED = frozenset('<>:"|?*') | {chr(code) for code in range(32)}
"""Characters that no file name of Windows has."""


def restrict():
    """Take away what Windows lacks."""
    real = {name: __import__(name) for name in WITHOUT}
    shown = {name: without(module, WITHOUT[name]) for name, module in real.items()}
    refuse_descriptors(shown["os"])
    import_module = builtins.__import__

    def imported(name, of_caller=None, *others, **options):
        module = import_module(name, of_caller, *others, **options)
        if str((of_caller or {}).get("__name__")).partition(".")[0] != "uictest" and not runs_as_main(
            of_caller
        ):
            return module
        if name in MISSING:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        return shown.get(name, module)

    builtins.__import__ = imported
    sys.addaudithook(refuse_as_windows_does)
    start_child = subprocess.Popen.__init__

    @wraps(start_child)
    def start(self, command, *arguments, **options):
        given = [name for name in POSIX_OPTIONS if options.get(name)]
        if given:
            raise ValueError(f"{given[0]} is not supported on Windows platforms")
        if command[0] == sys.executable:
            place = command.index("-m")
            command = [*command[:place], __file__, *command[place + 1 :]]
        start_child(self, command, *arguments, **options)

    subprocess.Popen.__init__ = start


def runs_as_main(of_caller):
    """Return whether a module of the package is what the process was started for."""
    spec = (of_caller or {}).get("__spec__")
    return spec is not None and spec.name.partition(".")[0] == "uictest"


def without(module, names):
    """Return a module without some of its names."""
    restricted = ModuleType(module.__name__)
    vars(restricted).update(
        {name: value for name, value in vars(module).items() if name not in names.split()}
    )
    return restricted


def refuse_descriptors(restricted_os):
    """Let no function take the descriptor of a folder."""
    for name, function in list(vars(restricted_os).items()):
        if function in list(os.supports_dir_fd):
            setattr(restricted_os, name, by_path_alone(function))
    for name in ("supports_dir_fd", "supports_fd", "supports_follow_symlinks"):
        setattr(restricted_os, name, set())


def by_path_alone(function):
    @wraps(function)
    def called(*arguments, **options):
        if any(name.endswith("dir_fd") for name in options):
            raise NotImplementedError(f"dir_fd unavailable on this platform: {function.__name__}")
        return function(*arguments, **options)

    return called


def refuse_as_windows_does(event, arguments):
    """Raise OSError for what Windows does not do with files, whoever asks for it."""
    if check := CHECKS.get(event):
        check(*arguments)


def renamed(old, new, *_):
    require_closed(old)
    require_closed(new)
    if os.path.lexists(new) and called_from("rename"):
        raise FileExistsError(183, "Cannot create a file when that file already exists", str(old))


def linked(_, path, *__):
    raise OSError(1314, "A required privilege is not held by the client", str(path))


def made(path, *_):
    require_name(path)


def opened(path, _, flags):
    if not isinstance(path, int) and flags & os.O_CREAT:
        require_name(path)


def called_from(name):
    """Return whether a function of this name of pathlib is what asks."""
    return sys._getframe(4).f_code.co_name == name


def require_name(path):
    """Raise OSError for a name that no file of Windows has."""
    name = Path(os.fsdecode(path)).name
    if REFUSED & set(name) or name.endswith((".", " ")):
        raise OSError(123, "The filename, directory name, or volume label syntax is incorrect", str(path))


def require_closed(path, folder=-1):
    """Raise PermissionError for a file that this process has open or mapped, or a folder that holds one."""
    above = f"/proc/self/fd/{folder}" if folder != -1 else ""
    place = os.path.join(os.path.realpath(above), os.fsdecode(path))  # noqa: PTH118 - paths take longer
    mapped = Path("/proc/self/maps").read_text("utf-8")
    if is_open_below(place) or f" {place}\n" in mapped or f" {place}/" in mapped:
        text = "The process cannot access the file because it is being used by another process"
        raise PermissionError(13, text, str(path))


def is_open_below(place):
    """Return whether this process has a regular file open that is at a place, or below it."""
    for descriptor in Path("/proc/self/fd").iterdir():
        with contextlib.suppress(OSError):
            target = str(descriptor.readlink())
            if f"{target}/".startswith(f"{place}/") and stat.S_ISREG(descriptor.stat().st_mode):
                return True
    return False


CHECKS = {
    "os.rename": renamed,
    "os.remove": require_closed,
    "os.rmdir": require_closed,
    "os.symlink": linked,
    "os.mkdir": made,
    "open": opened,
}


if __name__ == "__main__":
    restrict()
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
