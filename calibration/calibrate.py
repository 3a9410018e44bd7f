"""Calibrate the chosen parameters of valves, WSP controller and slide test against Lee and Kang (2015).

    python calibration/calibrate.py [--seed N] [--generations N]

scipy's differential evolution from a cloud around the values in the library, within stated bounds, with
a stated seed. Prints each improvement and, at the end, the values to write into the library; README.md
beside this file keeps the result and what was done with it.
"""

import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray
from objective import SLIDE, misfit
from parameters import FREE, values
from scipy.optimize import OptimizeResult, differential_evolution

from uictest.rig.model.rail import FRICTIONS

POPULATION = 30
SPREAD = 0.1
"""Standard deviation of the first cloud, as a share of the bounds."""


def main() -> None:
    """Run the search and print its result."""
    arguments = _arguments()
    generator = np.random.default_rng(arguments.seed)
    start = _present()
    cloud = np.clip(start + SPREAD * generator.standard_normal((POPULATION, len(FREE))), 0.0, 1.0)
    cloud[0] = start
    print(f"misfit of the library: {misfit(start):.3f}")
    best = differential_evolution(
        misfit,
        [(0.0, 1.0)] * len(FREE),
        rng=generator,
        init=cloud,
        maxiter=arguments.generations,
        mutation=(0.3, 0.8),
        recombination=0.6,
        tol=0.0,
        polish=False,
        callback=_report,
    )
    print(f"after {best.nfev} evaluations")
    _report(best)


def _report(intermediate_result: OptimizeResult) -> None:
    """Print the misfit and the values that have it."""
    chosen = values(intermediate_result.x)
    print(
        f"misfit {intermediate_result.fun:.3f}:",
        ", ".join(f"{k} {v:.4g}" for k, v in chosen.items()),
        flush=True,
    )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--generations", type=int, default=40)
    return parser.parse_args()


def _present() -> NDArray[np.float64]:
    """Free parameters as they stand in the library, as shares between their bounds."""
    record, leading = SLIDE.inputs.parameters, SLIDE.inputs.wheelset_parameters[0]
    delay = leading["valve_delay_cycles"] * record.cycle_time + leading["valve_delay_steps"] * record.step
    own = {**_numbers(leading), **_numbers(record), "switching_delay": delay}
    own["friction"] = SLIDE.inputs.rail[FRICTIONS, 0]
    shares = [free.share(float(own[free.name])) for free in FREE]
    return np.clip(np.array(shares), 0.0, 1.0)


def _numbers(record: Any) -> dict[str, Any]:
    return {name: record[name] for name in record.dtype.names}


if __name__ == "__main__":
    main()
