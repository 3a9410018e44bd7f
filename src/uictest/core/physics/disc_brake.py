"""Disc brake of one wheelset."""


def torque(
    clamping_force: float, calipers: float, pads: float, pad_friction: float, mean_radius: float
) -> float:
    """Largest brake torque on the wheelset, N m: calipers x pads x mu_pad x F x r_mean.

    Args:
        clamping_force: force of one pad on the disc, N.
        calipers: calipers per wheelset.
        pads: friction faces per caliper.
        pad_friction: friction coefficient between pad and disc.
        mean_radius: mean friction radius, m.
    """
    return calipers * pads * pad_friction * clamping_force * mean_radius
