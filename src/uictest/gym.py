"""The rig as a gymnasium environment; importing this module registers `uictest/Rig-v0`.

    import gymnasium
    import uictest.gym

    env = gymnasium.make("uictest/Rig-v0", scenario="slip.yaml")

It needs the extra `gym`. The environment is :class:`uictest.Rig` behind gymnasium's names; nothing of the rig
is different.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from uictest.api import Rig, RigState
from uictest.controllers import Inputs
from uictest.rig import assemble

Observation = NDArray[np.float64]
Reward = Callable[[RigState, RigState], float]
"""Reward of one step from the true states before and after it."""

_VALVES: Final = 4
FILL, HOLD, VENT = 0, 1, 2
"""What an action commands of a valve."""
LOCKED_BELOW: Final = 0.5
"""Circumferential speed below which the default reward counts a wheelset as locked, m/s; chosen."""
MOVING_ABOVE: Final = 5.0
"""Train speed above which it does, m/s; chosen: near standstill a lock wears no flat."""
LOCK_PENALTY: Final = 10.0
"""What it takes off per locked wheelset and second, in metres of braking distance; chosen."""
_SPEED_RANGE: Final = 1.5
"""Largest observed speed over the initial speed; chosen: readings beyond are cut off."""


def distance_and_locks(before: RigState, after: RigState) -> float:
    """Return minus the distance of a step, m, minus 10 m per second for each locked wheelset."""
    moves = after.train_speed > MOVING_ABOVE
    locked = sum(speed < LOCKED_BELOW for speed in after.wheel_speed) if moves else 0
    return before.distance - after.distance - LOCK_PENALTY * locked * (after.time - before.time)


class RigEnv(gymnasium.Env[Observation, NDArray[np.int64]]):
    """One stop per episode, one controller cycle per step.

    Action: FILL, HOLD or VENT (0, 1, 2) for each of the four valves. Observation, SI units: four wheel speeds
    and four cylinder pressures (gauge) as the sensors show them, and the brake demand (share of full
    service). An episode is terminated when the train stands, truncated after the scenario's longest duration.
    `info` holds the true state `time`, `distance` and `train_speed`, and at the end the `outcome`.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - gymnasium declares it so

    def __init__(
        self,
        scenario: str | Path,
        case: str | None = None,
        *,
        trust: Iterable[str | Path] = (),
        reward: Reward = distance_and_locks,
    ) -> None:
        """Read a scenario. Arguments as for :class:`uictest.Rig`; `reward` replaces the default one."""
        self.rig = Rig(scenario, case, trust=trust)
        self._reward = reward
        parameters = assemble(self.rig.case).parameters
        speed = _SPEED_RANGE * float(parameters["initial_speed"])
        pressure = float(parameters["compressor_cut_out"])  # absolute: above any gauge pressure of the rig
        high = np.array([speed] * 4 + [pressure] * 4 + [1.0])
        self.observation_space = spaces.Box(np.zeros(9), high, dtype=np.float64)
        self.action_space = spaces.MultiDiscrete([3] * _VALVES)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin a stop; noise and random rail come from the environment's generator, which `seed` sets."""
        super().reset(seed=seed)
        inputs = self.rig.reset(int(self.np_random.integers(2**32)))
        return self._observation(inputs), _info(self.rig.state)

    def step(self, action: NDArray[np.int64]) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Carry out one action for one controller cycle. Raises ValueError for what is no action."""
        before = self.rig.state
        commands = _commands(action)
        inputs = self.rig.step(
            hold=[each != FILL for each in commands], vent=[each == VENT for each in commands]
        )
        after, ended = self.rig.state, self.rig.stopped
        info = _info(after)
        if ended:
            info["outcome"] = self.rig.result().outcome
        stands = ended and self.rig.stands
        return self._observation(inputs), self._reward(before, after), stands, ended and not stands, info

    def _observation(self, inputs: Inputs) -> Observation:
        values = np.array([*inputs.wheel_speed, *inputs.cylinder_pressure, inputs.brake_demand])
        return np.clip(values, self.observation_space.low, self.observation_space.high)  # type: ignore[attr-defined]


def _commands(action: Any) -> list[int]:
    """Return the command of each valve; a number between two commands, or beyond them, is none of them."""
    values = np.asarray(action)
    whole = values.shape == (_VALVES,) and values.dtype.kind in "iu"
    if not whole or not ((values >= FILL) & (values <= VENT)).all():
        raise ValueError(
            f"{action!r} is no action: it has {_VALVES} whole numbers, each {FILL} (fill), {HOLD} (hold) or"
            f" {VENT} (vent)"
        )
    return [int(each) for each in values]


def _info(state: RigState) -> dict[str, Any]:
    return {"time": state.time, "distance": state.distance, "train_speed": state.train_speed}


gymnasium.register(id="uictest/Rig-v0", entry_point="uictest.gym:RigEnv")
