from .listing import (
    LIST as LIST,
    begin_list as begin_list,
    relative_path as relative_path,
    remove_listed as remove_listed,
)
from .lock import FolderInUseError as FolderInUseError, FolderLock as FolderLock
from .run_folder import (
    LATEST as LATEST,
    ForeignFileError as ForeignFileError,
    RunFolder as RunFolder,
    latest_run as latest_run,
    point_latest as point_latest,
    remove_run as remove_run,
    replaced_folder as replaced_folder,
)
from .writing import (
    WriteError as WriteError,
    append as append,
    make_folder as make_folder,
    new_file as new_file,
    new_temporary_folder as new_temporary_folder,
    remove as remove,
    remove_partial_files as remove_partial_files,
    remove_temporary_folder as remove_temporary_folder,
    require_place as require_place,
    temporary_folder as temporary_folder,
    write as write,
    write_all as write_all,
    write_to as write_to,
    writing as writing,
)
