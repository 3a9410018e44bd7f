"""How a record is prepared before it is measured: every choice named, and printed with the verdict."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from uictest.scenario.yaml import Model, Quantity, default, kind

Trigger = Literal["auto", "stated", "start", "command", "demand", "pressure"]


class Preparation(Model):
    """Trigger, raster, filter and standstill. No published rule exists for any of them: all are chosen."""

    trigger: Trigger = Field(
        default="auto",
        description="What marks the brake command: a time the file states, its start, the brake command, the"
        " demanded pressure or the first pressure to rise; auto takes the first of these that is recorded.",
    )
    trigger_time: Annotated[Quantity, kind("time", at_least="-1e10 s", at_most="1e10 s")] | None = Field(
        default=None, description="Time of the brake command in the file; takes the place of `trigger`."
    )
    trigger_lead: Annotated[Quantity, kind("time", at_least="0 s", at_most="60 s")] = Field(
        default=default("0 s", "time"),
        description="How long the brake command was given before what marks it.",
    )
    trigger_pressure: Annotated[Quantity, kind("pressure", above="0 bar", at_most="10 bar")] = Field(
        default=default("0.1 bar", "pressure"), description="Rise of a pressure that marks the brake command."
    )
    trigger_speed: Annotated[Quantity, kind("speed", at_least="0 km/h", at_most="600 km/h")] = Field(
        default=default("5 km/h", "speed"), description="The train must run faster than this at the trigger."
    )
    raster: Annotated[Quantity, kind("time", at_least="0.1 ms", at_most="1 s")] = Field(
        default=default("10 ms", "time"),
        description="Interval at which the record is measured; a coarser record keeps its own.",
    )
    low_pass: Annotated[Quantity, kind("frequency", above="0 Hz", at_most="100000 Hz")] | None = Field(
        default=None,
        description="Corner frequency of a low-pass on every signal, second order, without delay; else none.",
    )
    standstill_speed: Annotated[Quantity, kind("speed", above="0 km/h", at_most="10 km/h")] = Field(
        default=default("1 km/h", "speed"),
        description="Slower than this the train is about to stand: where no sample of zero follows, the rest"
        " is run at the deceleration of the last half second.",
    )
