"""How far a rig may differ from the one a compensation was identified for: the tolerances of six-inch.

Each parameter is moved alone, by a ladder of shares to both sides, on the rig with one caliper and on the one
with four. Its tolerance is the largest share up to which the dry stop of scenarios/dry-120.yaml (120 km/h,
position R, full command, seed 0) differs by less than 0.5 % between the two, with `thermal` and with `full`.
"""

from pathlib import Path

from uictest import rig
from uictest.scenario import Case, load

SCENARIO = Path(__file__).parent.parent / "scenarios" / "dry-120.yaml"
KEYS = (
    *(
        f"rig.caliper.{name}"
        for name in (
            *("piston_area", "preload", "spring_rate", "coulomb_friction", "load_friction"),
            *("viscous_friction", "contact_friction", "clearance", "contact_stiffness", "lever_ratio"),
        )
    ),
    "brake.system.tank.volume",
    *(
        f"brake.system.wsp_valve.{name}"
        for name in ("fill_conductance", "vent_conductance", "switching_delay", "travel_time")
    ),
)
LADDER = (
    0.001,
    0.002,
    0.003,
    0.004,
    0.006,
    0.01,
    0.015,
    0.02,
    0.03,
    0.05,
    0.075,
    0.1,
    0.15,
    0.2,
    0.3,
    0.4,
    0.5,
)
WITHIN = 0.005
SETTINGS = ("thermal", "full")


def distance(case: Case) -> float:
    """Return the braking distance of a case, m."""
    return float(rig.simulate(case).measures.braking_distance)


def value_of(case: Case, key: str) -> float:
    """Return the value of a key, in the unit of the scenario's model."""
    value: object = case.scenario
    for name in key.split("."):
        value = getattr(value, name)
    return float(value)  # type: ignore[arg-type]


def differences(overrides: tuple[str, ...] = ()) -> list[float]:
    """Return how far the rig with one caliper stops from the one with four, for each setting."""
    (four,) = load([SCENARIO], ["rig.topology=four-caliper", *overrides])
    reference = distance(four)
    cases = (load([SCENARIO], [f"rig.compensation={name}", *overrides])[0] for name in SETTINGS)
    return [distance(case) / reference - 1.0 for case in cases]


UNITS = {
    "piston_area": "m2",
    **dict.fromkeys(("preload", "coulomb_friction"), "N"),
    **dict.fromkeys(("spring_rate", "contact_stiffness"), "N/m"),
    **dict.fromkeys(("viscous_friction", "contact_friction"), "N s/m"),
    "clearance": "m",
    "load_friction": "",
    "lever_ratio": "",
    "volume": "m3",
    **dict.fromkeys(("fill_conductance", "vent_conductance"), "m3/(s Pa)"),
    **dict.fromkeys(("switching_delay", "travel_time"), "s"),
}


def written(key: str, value: float) -> str:
    """Return an override that sets a key to a value in SI units."""
    name = key.rsplit(".", 1)[1]
    if name == "load_friction":
        return f"{key}={100.0 * value!r} %"
    if name == "clearance":
        return f"{key}={1e3 * value!r} mm"
    return f"{key}={value!r} {UNITS[name]}".rstrip()


def main() -> None:
    """Print the tolerance of every parameter, and the differences at its two ends and one step beyond."""
    print("nominal", *(f"{name} {100.0 * d:+.2f} %" for name, d in zip(SETTINGS, differences(), strict=True)))
    (nominal,) = load([SCENARIO])
    for key in KEYS:
        value, tolerance, shown = value_of(nominal, key), 0.0, ""
        for share in LADDER:
            ends = [differences((written(key, value * (1.0 + sign * share)),)) for sign in (-1.0, 1.0)]
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
