"""How far a rig may differ from the one a compensation was identified for: the tolerances of six-inch.

Each parameter is moved alone, by a ladder of shares to both sides, on the rig with one caliper and on the one
with four. Its tolerance is the largest share up to which the dry stop of scenarios/dry-120.yaml (120 km/h,
position R, full command, seed 0) differs by less than 0.5 % between the two, with `thermal` and with `full`.
"""

from pathlib import Path

from uictest import rig
from uictest.core.units import in_unit
from uictest.plans.scenario import Case, Quantity, load, rig_as_built

SCENARIO = Path(__file__).parent.parent / "scenarios" / "dry-120.yaml"
LADDER = (
    *(0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.01, 0.015, 0.02),
    *(0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5),
)
WITHIN = 0.005
SETTINGS = ("thermal", "full")


def distance(case: Case) -> float:
    """Return the braking distance of a case, m."""
    return float(rig.simulate(case).measures.braking_distance)


def differences(overrides: tuple[str, ...] = ()) -> list[float]:
    """Return how far the rig with one caliper stops from the one with four, for each setting."""
    (four,) = load([SCENARIO], ["rig.topology=four-caliper", *overrides])
    reference = distance(four)
    cases = (load([SCENARIO], [f"rig.compensation={name}", *overrides])[0] for name in SETTINGS)
    return [distance(case) / reference - 1.0 for case in cases]


def written(key: str, nominal: Quantity, share: float) -> str:
    """Return an override that moves a key by a share, in the unit in which the library writes it."""
    unit = nominal.text.partition(" ")[2]
    return f"{key}={in_unit(nominal * (1.0 + share), unit or '1')!r} {unit}".rstrip()


def main() -> None:
    """Print the tolerance of every parameter, and the differences at its two ends and one step beyond."""
    print("nominal", *(f"{name} {100.0 * d:+.2f} %" for name, d in zip(SETTINGS, differences(), strict=True)))
    (nominal,) = load([SCENARIO])
    for key, value in rig_as_built(nominal.scenario).items():
        tolerance, shown = 0.0, ""
        for share in LADDER:
            ends = [differences((written(key, value, sign * share),)) for sign in (-1.0, 1.0)]
            text = ", ".join(
                f"{sign}{100.0 * share:g} %: " + "/".join(f"{100.0 * each:+.2f}" for each in end)
                for sign, end in zip("-+", ends, strict=True)
            )
            if max(abs(each) for end in ends for each in end) >= WITHIN:
                shown += f"   beyond {text}"
                break
            tolerance, shown = share, text
        print(f"{key} {100.0 * tolerance:g} %   {shown}", flush=True)


if __name__ == "__main__":
    main()
