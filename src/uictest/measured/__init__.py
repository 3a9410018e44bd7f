"""Measured stops: from the channels of a file to samples, measures and verdicts.

A channel map names the channels; trigger, raster, filter and standstill are chosen in the open; defects are
found and named, never bridged. What comes out is judged by the code that judges simulated stops.
"""

from uictest.measured.channel_map import ChannelMap, load_map, presets
from uictest.measured.circumstances import FACTS, stated_case
from uictest.measured.defect import Defect
from uictest.measured.file import digest_of, stop_in
from uictest.measured.judgement import judge_recording, judge_stop, unusable_result
from uictest.measured.preparation import Preparation
from uictest.measured.prepare import MeasuredStop, UnusableError, prepare
from uictest.measured.proposal import fitting_preset, lacks_essentials, listing, proposed_map, remarks
from uictest.measured.raw import MapError, RawChannel, select
from uictest.measured.subject import recorded_subject

__all__ = [
    "FACTS",
    "ChannelMap",
    "Defect",
    "MapError",
    "MeasuredStop",
    "Preparation",
    "RawChannel",
    "UnusableError",
    "digest_of",
    "fitting_preset",
    "judge_recording",
    "judge_stop",
    "lacks_essentials",
    "listing",
    "load_map",
    "prepare",
    "presets",
    "proposed_map",
    "recorded_subject",
    "remarks",
    "select",
    "stated_case",
    "stop_in",
    "unusable_result",
]
