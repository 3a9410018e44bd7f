from .contract import (
    Conflict as Conflict,
    ControlledWheelset as ControlledWheelset,
    Controller as Controller,
    ControllerCycle as ControllerCycle,
    ControllerParameters as ControllerParameters,
    DeclaredParameter as DeclaredParameter,
    TrainMemory as TrainMemory,
)
from .registry import CONTROLLERS as CONTROLLERS, DEFAULT as DEFAULT
