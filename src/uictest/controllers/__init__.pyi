from .adapters import open_controller as open_controller
from .adapters.errors import ControllerError as ControllerError, OnlyOneError as OnlyOneError
from .adapters.instance import (
    CalledInstance as CalledInstance,
    ControllerInstance as ControllerInstance,
    ResponseTimes as ResponseTimes,
    read_inputs as read_inputs,
    stated_declarations as stated_declarations,
    write_outputs as write_outputs,
)
from .adapters.registered import (
    functions_of_addresses as functions_of_addresses,
    in_si as in_si,
    memory_of as memory_of,
)
from .adapters.turns import interrupt_turns as interrupt_turns
from .contract import (
    CONTROLLERS as CONTROLLERS,
    DEFAULT as DEFAULT,
    BrakedTrain as BrakedTrain,
    BrakedWheelset as BrakedWheelset,
    Conflict as Conflict,
    ControlledWheelset as ControlledWheelset,
    Controller as Controller,
    ControllerCycle as ControllerCycle,
    ControllerParameters as ControllerParameters,
    DeclaredParameter as DeclaredParameter,
    TrainMemory as TrainMemory,
)
from .declared import (
    CONTRACTS as CONTRACTS,
    HEADER as HEADER,
    LONGEST_VERSION as LONGEST_VERSION,
    ControllerProgram as ControllerProgram,
    Kind as Kind,
    Problem as Problem,
    ProgramKey as ProgramKey,
    installed_module as installed_module,
    installed_names as installed_names,
    installed_version as installed_version,
    nothing_declared as nothing_declared,
    parameter_problems as parameter_problems,
    shown_version as shown_version,
)
from .interface import (
    CLOSING as CLOSING,
    DAMAGED as DAMAGED,
    EXCHANGE as EXCHANGE,
    EXPLAINING as EXPLAINING,
    FORBIDDEN_COMMAND as FORBIDDEN_COMMAND,
    GUARD as GUARD,
    INPUTS as INPUTS,
    NO_FAILURE as NO_FAILURE,
    NO_MAGNET_STATE as NO_MAGNET_STATE,
    NO_REDUCTION as NO_REDUCTION,
    NO_REQUEST as NO_REQUEST,
    NOT_CALLED as NOT_CALLED,
    OPENING as OPENING,
    OUTPUTS as OUTPUTS,
    OUTPUTS_AT as OUTPUTS_AT,
    STEP_FAILED as STEP_FAILED,
    STEPPING as STEPPING,
    UNTOUCHED as UNTOUCHED,
    WROTE_BEYOND as WROTE_BEYOND,
    Config as Config,
    Inputs as Inputs,
    Outputs as Outputs,
    PythonController as PythonController,
)
