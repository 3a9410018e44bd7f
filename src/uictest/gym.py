"""The rig as a gymnasium environment; importing this module registers `uictest/Rig-v0`.

    import gymnasium
    import uictest.gym

    env = gymnasium.make("uictest/Rig-v0", scenario="slip.yaml")

It needs the extra `gym`. The environment is :class:`uictest.Rig` behind gymnasium's names; nothing of the rig
is different.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from uictest.api import Rig, RigState
from uictest.controllers import Inputs, Outputs
from uictest.rig import assemble

Observation = NDArray[np.float64]
Action = NDArray[np.int64] | Mapping[str, Any]
"""Commands of the valves; with contract version 2 a dictionary."""
Reward = Callable[[RigState, RigState], float]
"""Reward of one step from the true states before and after it."""

_VALVES: Final = 4
_REQUESTS: Final = ("dynamic_reduction", "sand_request", "track_brake_request")
_HEAVIEST_AXLE: Final = 400e3
"""Largest axle load observed, N; chosen: above any railway's."""
_LARGEST_ACCELERATION: Final = 20.0
"""Largest acceleration observed either way, m/s2; chosen: above any stop's."""
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


class RigEnv(gymnasium.Env[Observation, Action]):
    """One stop per episode, one controller cycle per step.

    Action: FILL, HOLD or VENT (0, 1, 2) for each of the four valves. With `contract=2` a dictionary of
    `valves`, the same, and what it adds: `dynamic_reduction`, `sand_request`, `track_brake_request`, as
    :class:`uictest.controllers.Outputs` has them.

    Observation, SI units: four wheel speeds and four cylinder pressures (gauge) as the sensors show them, and
    the brake demand (share of full service); with `contract=2` also the four `dynamic_brake` and what follows
    it in :class:`uictest.controllers.Inputs`, in that order, truth values as 0 and 1. An episode is
    terminated when the train stands, truncated after the scenario's longest duration. `info` holds the true
    state `time`, `distance` and `train_speed`, and at the end the `outcome`.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - gymnasium declares it so

    def __init__(
        self,
        scenario: str | Path,
        case: str | None = None,
        *,
        trust: Iterable[str | Path] = (),
        reward: Reward = distance_and_locks,
        contract: int = 1,
    ) -> None:
        """Read a scenario. Arguments as for :class:`uictest.Rig`; `reward` replaces the default one."""
        self.rig = Rig(scenario, case, trust=trust, contract=contract)
        self._reward = reward
        self._contract = contract
        parameters = assemble(self.rig.case).parameters
        speed = _SPEED_RANGE * float(parameters["initial_speed"])
        pressure = float(parameters["compressor_cut_out"])  # absolute: above any gauge pressure of the rig
        high = np.array([speed] * 4 + [pressure] * 4 + [1.0])
        low = np.zeros(len(high))
        valves: Any = spaces.MultiDiscrete([3] * _VALVES)
        self.action_space = valves
        if contract > 1:
            of_train = [_HEAVIEST_AXLE, 1.0, speed, 1.0, _LARGEST_ACCELERATION, 1.0]
            high = np.array([*high, *([1.0] * _VALVES), *of_train])
            low = np.zeros(len(high))
            low[-2] = -_LARGEST_ACCELERATION
            self.action_space = spaces.Dict(
                valves=valves,
                dynamic_reduction=spaces.Box(0.0, 1.0, (_VALVES,), np.float64),
                sand_request=spaces.MultiBinary(_VALVES),
                track_brake_request=spaces.Discrete(2),
            )
        self.observation_space = spaces.Box(low, high, dtype=np.float64)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin a stop; noise and random rail come from the environment's generator, which `seed` sets."""
        super().reset(seed=seed)
        inputs = self.rig.reset(int(self.np_random.integers(2**32)))
        return self._observation(inputs), _info(self.rig.state)

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Carry out one action for one controller cycle. Raises ValueError for what is no action."""
        before = self.rig.state
        inputs = self.rig.step(_valves(action) if self._contract == 1 else _all_commands(action))
        after, ended = self.rig.state, self.rig.stopped
        info = _info(after)
        if ended:
            info["outcome"] = self.rig.result().outcome
        stands = ended and self.rig.stands
        return self._observation(inputs), self._reward(before, after), stands, ended and not stands, info

    def _observation(self, inputs: Inputs) -> Observation:
        values = [*inputs.wheel_speed, *inputs.cylinder_pressure, inputs.brake_demand]
        if self._contract > 1:
            values += [*inputs.dynamic_brake, inputs.axle_load, inputs.brake_command]
            values += [inputs.train_speed, inputs.train_speed_valid]
            values += [inputs.acceleration, inputs.acceleration_valid]
        return np.clip(np.array(values), self.observation_space.low, self.observation_space.high)  # type: ignore[attr-defined]


def _valves(action: Any) -> Outputs:
    """Return the commands of the valves; a number between two commands, or beyond them, is none of them."""
    values = np.asarray(action)
    whole = values.shape == (_VALVES,) and values.dtype.kind in "iu"
    if not whole or not ((values >= FILL) & (values <= VENT)).all():
        raise ValueError(
            f"{action!r} is no action: it has {_VALVES} whole numbers, each {FILL} (fill), {HOLD} (hold) or"
            f" {VENT} (vent)"
        )
    return Outputs([each != FILL for each in values.tolist()], [each == VENT for each in values.tolist()])


def _all_commands(action: Any) -> Outputs:
    """Return the commands of contract version 2; the rig refuses those that are out of range."""
    if not isinstance(action, Mapping) or action.keys() != {"valves", *_REQUESTS}:
        raise ValueError(f"{action!r} is no action: it has valves, {', '.join(_REQUESTS)}")
    outputs = _valves(action["valves"])
    for name in _REQUESTS:
        setattr(outputs, name, np.asarray(action[name]).tolist())
    return outputs


def _info(state: RigState) -> dict[str, Any]:
    return {"time": state.time, "distance": state.distance, "train_speed": state.train_speed}


gymnasium.register(id="uictest/Rig-v0", entry_point="uictest.gym:RigEnv")
