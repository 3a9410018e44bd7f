from .mean import (
    mean_interval as mean_interval,
    next_interval as next_interval,
    proportion_interval as proportion_interval,
    trials_needed as trials_needed,
)
from .order_statistics import (
    BoundRanks as BoundRanks,
    Side as Side,
    bound_ranks as bound_ranks,
    draws_needed as draws_needed,
    quantile_rank as quantile_rank,
)
