from .listing import (
    ENTRY as ENTRY,
    MANIFEST as MANIFEST,
    OF_RECORDINGS as OF_RECORDINGS,
    Kind as Kind,
    ListedRun as ListedRun,
    Listing as Listing,
    Unlisted as Unlisted,
    list_runs as list_runs,
    read_folder as read_folder,
    write_entry as write_entry,
)
from .page import INDEX as INDEX, is_own_index as is_own_index, refresh_index as refresh_index
from .pruning import Pruned as Pruned, prune as prune
