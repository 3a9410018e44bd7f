"""The gymnasium environment is the rig behind other names."""

import warnings

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="the extra gym is not installed")

import uictest.gym  # noqa: E402
from uictest.api import RigState  # noqa: E402


def made(path, **options):
    return gymnasium.make("uictest/Rig-v0", scenario=path, **options).unwrapped


def test_gymnasium_finds_nothing_to_complain_about(write_scenario):
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(made(write_scenario()))


def test_an_episode_is_a_stop(write_scenario):
    env = made(write_scenario())
    _, start = env.reset(seed=3)
    rewards, distances, ended = [], [start["distance"]], False
    while not ended:
        observation, reward, terminated, truncated, info = env.step(np.array([0, 0, 0, 0]))
        rewards.append(reward)
        distances.append(info["distance"])
        ended = terminated or truncated
        assert observation in env.observation_space
    assert (terminated, truncated) == (True, False)
    assert info["outcome"] == env.rig.result().outcome
    # Everything locks, so that more than the distance is taken off.
    assert sum(rewards) < -distances[-1]


def test_an_action_vents_its_wheelset_and_no_other(write_scenario):
    env = made(write_scenario())
    env.reset(seed=1)
    for _ in range(300):
        env.step(np.array([2, 0, 1, 0]))
    vented, filled, held, _ = env.rig.state.tank_pressure
    assert vented == pytest.approx(held, abs=2e4)
    assert filled > vented + 2e5


@pytest.mark.parametrize(
    "action",
    [[3, 0, 0, 0], [0, -1, 0, 0], [0.0, 0.0, 2.9, 0.0], [1.0] * 4, [0] * 3, [[0] * 4], 2, [True] * 4],
)
def test_what_is_no_action_is_refused_and_leaves_the_stop(write_scenario, action):
    """3 held, -1 held and 2.9 vented."""
    env = made(write_scenario())
    env.reset(seed=1)
    before = env.rig.state
    for given in (action, np.array(action)):
        with pytest.raises(ValueError, match="is no action: it has 4 whole numbers"):
            env.step(given)
    assert env.rig.state == before


def test_a_reward_of_ones_own(write_scenario):
    def shortest(before, after):
        return before.time - after.time

    env = made(write_scenario(), reward=shortest)
    env.reset(seed=1)
    assert env.step(np.array([0, 0, 0, 0]))[1] == pytest.approx(-0.01)


def test_a_stop_without_a_locked_wheelset_costs_its_distance():
    four = (20.0, 20.0, 20.0, 20.0)
    before = RigState(1.0, 10.0, 20.0, four, *[(0.0,) * 4] * 5, 8e5)
    after = RigState(1.01, 10.2, 20.0, four, *[(0.0,) * 4] * 5, 8e5)
    locked = RigState(1.01, 10.2, 20.0, (0.0, 0.0, 20.0, 20.0), *[(0.0,) * 4] * 5, 8e5)
    assert uictest.gym.distance_and_locks(before, after) == pytest.approx(-0.2)
    assert uictest.gym.distance_and_locks(before, locked) == pytest.approx(-0.4)


MOTORS = (
    "brake: {dynamic: {force: 60 kN, power: 1.6 MW}, track: {attraction: 50 kN, when: requested}}\n"
    'controller: {connect: "tcp://127.0.0.1:1"}\nrig: {sensors: {extends: standard, acceleration: {}}}\n'
)


def test_with_contract_2_an_action_reduces_the_dynamic_brake_and_asks_for_the_track_brake(write_scenario):
    from gymnasium.utils.env_checker import check_env

    env = made(write_scenario(MOTORS), contract=2)
    check_env(env)
    env.reset(seed=1)
    action = {
        "valves": np.zeros(4, int),
        "dynamic_reduction": np.array([0.0, 1.0, 0.0, 0.0]),
        "sand_request": np.zeros(4, np.int8),
        "track_brake_request": 1,
    }
    for _ in range(200):
        observation, *_ = env.step(action)
    assert observation.shape == (19,)
    motors, (axle_load, command), second = observation[9:13], observation[13:15], observation[15:]
    assert motors[1] == 0.0
    assert min(motors[[0, 2, 3]]) > 0.5
    assert 50e3 < axle_load < 200e3
    assert command == 1.0
    assert second.tolist()[:2] == [0.0, 0.0]
    assert second[2] < -0.5
    assert second[3] == 1.0
    for wrong in (action | {"dynamic_reduction": [0.0, 2.0, 0.0, 0.0]}, {"valves": [0] * 4}, [0] * 4):
        with pytest.raises(ValueError, match=r"is no action|expected 0 to 1"):
            env.step(wrong)
