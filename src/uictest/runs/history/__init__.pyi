from .entry import ENTRY as ENTRY, write_entry as write_entry
from .listing import Listing as Listing, list_runs as list_runs
from .page import INDEX as INDEX, is_own_index as is_own_index, refresh_index as refresh_index
from .pruning import Pruned as Pruned, prune as prune
from .run_in_folder import (
    MANIFEST as MANIFEST,
    OF_RECORDINGS as OF_RECORDINGS,
    Kind as Kind,
    ListedRun as ListedRun,
    Unlisted as Unlisted,
    read_folder as read_folder,
)
