"""A day of a train on its recorder, with known truth: what was braked, and what the recorder lost."""

from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter

PRESSURE, OFFSET, RISE = 3e5, 0.15e5, 0.3
"""Pa with the brake applied, Pa that the sensor shows with it released, and time constant, s."""
STANDS = 0.3
"""m/s from which on a stop has come to its end."""

SHUNTING = (2.5, 4.5)
"""m/s; a train speed of zero is not told from a dead sensor where the wheels run slower than 2 m/s."""


class Braking(NamedTuple):
    """One application: sample at which it begins, what it is, and how far the train then ran to its stop, m.

    `reason` is empty for a stop; `clean` says that the recorder lost nothing of it.
    """

    row: int
    kind: str
    reason: str
    distance: float = float("nan")
    clean: bool = True


class Scenes:
    """Speed of a train and its brake, scene after scene, at `rate` samples a second."""

    def __init__(self, draw, rate):
        self.draw, self.rate, self.rows, self.direction = draw, rate, 0, 1.0
        self.speeds, self.brakes, self.slides = [np.zeros(0)], [np.zeros(0)], [np.zeros(0)]
        self.brakings, self.lost, self.now = [], [], 0.0

    def drive(self, seconds, end=None, applied=False, slide=0.0):
        """Run from the present speed to another one."""
        count = max(round(seconds * self.rate), 1)
        end = self.now if end is None else end
        self.speeds.append(self.direction * (self.now + (end - self.now) * np.arange(1, count + 1) / count))
        self.brakes.append(np.full(count, float(applied)))
        self.slides.append(np.full(count, slide))
        self.rows += count
        self.now = end

    def brake_to(self, end, slide=0.0):
        deceleration = self.draw.uniform(0.5, 1.4)
        self.drive(0.5, applied=True)
        self.drive((self.now - end) / deceleration, end, True, slide)

    def note(self, kind, reason=""):
        self.brakings.append(Braking(self.rows, kind, reason))

    def accelerate(self, speed):
        spin = -self.draw.choice([0.0, 0.0, 0.4])
        self.drive(abs(speed - self.now) / self.draw.uniform(0.4, 1.0), speed, slide=spin)
        self.drive(self.draw.uniform(5.0, 40.0))

    def on_the_way(self):
        """Brake without stopping, or pretend to."""
        kind = self.draw.choice(["released", "drag", "coasting", "blip"])
        if kind == "released":
            self.note(kind, "released at")
            self.brake_to(self.now * self.draw.uniform(0.4, 0.85))
            self.accelerate(max(self.now, 9.0))
        elif kind == "drag":
            self.note(kind, "drag")
            self.drive(self.draw.uniform(20.0, 300.0), self.now * 0.97, applied=True)
        elif kind == "coasting":
            self.drive(30.0, max(0.7 * self.now, 8.0))
        self.drive(self.draw.uniform(6.0, 60.0))

    def stop(self, kind):
        """Brake to a stop, which stands with the brake applied for a while."""
        self.note(kind, "interrupted" if kind == "interrupted" else "")
        if kind == "after drag":
            self.brake_to(0.6 * self.now)
            self.drive(self.draw.uniform(25.0, 60.0), applied=True)
        if kind == "short release":
            self.brake_to(0.5 * self.now)
            self.drive(1.3)
        first = self.rows
        self.brake_to(0.0, self.draw.uniform(0.1, 0.6) if kind == "slide" else 0.0)
        middle = (first + self.rows) // 2
        self.drive(80.0 if kind == "interrupted" else self.draw.uniform(1.0, 60.0), applied=True)
        if kind == "interrupted":
            self.lost.append((middle, self.rows + 5 * self.rate))
        self.drive(self.draw.uniform(6.0, 60.0))

    def standing(self):
        """Test the brake, shunt, turn round or wait."""
        kind = self.draw.choice(["test", "shunting", "turn", "wait", "wait", "roll"])
        if kind == "turn":
            self.direction *= -1.0
        for _ in range(self.draw.integers(1, 4) if kind in ("test", "shunting") else 0):
            self.drive(5.0)
            if kind == "shunting":
                self.accelerate(self.draw.uniform(*SHUNTING))
            self.note(kind, "without motion" if kind == "test" else "below")
            if kind == "shunting":
                self.brake_to(0.0)
            self.drive(self.draw.uniform(3.0, 20.0), applied=True)
        if kind == "roll":
            self.accelerate(3.0)
            self.drive(60.0, 0.0)
        self.drive(self.draw.uniform(5.0, 60.0))


KINDS = ("plain", "plain", "slide", "after drag", "short release", "interrupted")


def scenes(seed, stops, rate, hours=0.0):
    """Return scenes with so many stops; the train is parked in the middle until they take so many hours."""
    acted = Scenes(np.random.default_rng(seed), rate)
    acted.drive(30.0)
    done = 0
    while done < stops:
        if done == stops // 2 and (missing := hours * 3600.0 - 2.0 * acted.rows / rate) > 0.0:
            acted.drive(missing)
        acted.standing()
        acted.accelerate(acted.draw.uniform(9.0, 45.0))
        for _ in range(acted.draw.integers(0, 3)):
            acted.on_the_way()
        kind = acted.draw.choice(KINDS)
        acted.stop(kind)
        done += kind != "interrupted"
    return acted


def recorded(acted):
    """Return channels as they were recorded, and every application of the brake with its sample."""
    draw, rate, rows = acted.draw, acted.rate, acted.rows
    speed, slide = np.concatenate(acted.speeds), np.concatenate(acted.slides)
    share = float(np.exp(-1.0 / (rate * RISE)))
    pressure = lfilter([1.0 - share], [1.0, -share], PRESSURE * np.concatenate(acted.brakes))
    moving = speed != 0.0
    columns = {"time": np.arange(rows) / rate, "speed": speed + moving * draw.normal(0.0, 0.03, rows)}
    for n in (1, 2, 3, 4):
        own = speed * (1.0 - slide * draw.uniform(0.3, 1.0)) * draw.uniform(0.995, 1.005)
        columns[f"wheel_speed_{n}"] = own + moving * draw.normal(0.0, 0.03, rows)
    columns["brake_line_pressure"] = pressure + OFFSET + draw.normal(0.0, 0.01e5, rows)
    travelled = np.concatenate(([0.0], np.cumsum(np.abs(speed)) / rate))
    standing = np.flatnonzero(np.abs(speed) < STANDS)
    touched, kept = np.zeros(rows, dtype=np.bool_), np.ones(rows, dtype=np.bool_)
    _kill_sensors(columns, touched, draw, rate)
    _step_clock(columns["time"], touched, draw, rate)
    _lose_rows(acted, columns["time"], kept, draw)
    new_row = np.cumsum(kept) - 1
    brakings = []
    for each in acted.brakings:
        end = int(standing[np.searchsorted(standing, each.row)]) if not each.reason else each.row
        near = slice(max(each.row - 6 * rate, 0), end + 4 * rate)
        brakings.append(
            each._replace(
                row=int(new_row[each.row]),
                distance=float(travelled[end] - travelled[each.row]),
                clean=not touched[near].any(),
            )
        )
    return {name: samples[kept] for name, samples in columns.items()}, brakings


def _kill_sensors(columns, touched, draw, rate):
    """The train speed is lost, zero or stuck now and then; a wheel speed dies for good at half time."""
    rows = len(touched)
    for _ in range(max(rows // (3600 * rate), 2)):
        first = int(draw.integers(rows))
        part = slice(first, first + round(draw.uniform(30.0, 900.0) * rate))
        columns["speed"][part] = draw.choice([np.nan, 0.0, columns["speed"][first]])
        touched[part] = True
    columns[f"wheel_speed_{draw.integers(1, 5)}"][rows // 2 :] = draw.choice([np.nan, 0.0])


def _step_clock(time, touched, draw, rate):
    """The clock is put right, or begins again."""
    rows = len(time)
    for _ in range(max(rows // (1800 * rate), 4)):
        first = int(draw.integers(1, rows))
        reset = -time[first]
        time[first:] += draw.choice([reset, draw.uniform(-3600.0, -0.5), draw.uniform(61.0, 7200.0)])
        touched[first] = True


def _lose_rows(acted, time, kept, draw):
    """Samples are missing while nothing is braked, and in the middle of interrupted stops."""
    rate, rows = acted.rate, acted.rows
    busy = np.concatenate(acted.brakes) > 0.0
    for _ in range(max(rows // (3600 * rate), 3)):
        first = int(draw.integers(rows))
        last = min(first + round(draw.uniform(0.05, 300.0) * rate), rows)
        if not busy[max(first - 20 * rate, 0) : last + 20 * rate].any():
            kept[first:last] = False
    for first, last in acted.lost:
        kept[first:last] = False
