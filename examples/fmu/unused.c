/* Functions that every FMU exports and that this one has no use for: each returns error, whatever it is
 * given. No header is included, so that they need no parameters. */
#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif
#define UNUSED(name) EXPORT int name() { return 3; }
#define NONE(name) EXPORT void *name() { return 0; }

#if FMI == 2
UNUSED(fmi2CancelStep) UNUSED(fmi2DeSerializeFMUstate) UNUSED(fmi2FreeFMUstate)
UNUSED(fmi2GetBooleanStatus) UNUSED(fmi2GetDirectionalDerivative) UNUSED(fmi2GetFMUstate)
UNUSED(fmi2GetIntegerStatus) UNUSED(fmi2GetRealOutputDerivatives) UNUSED(fmi2GetRealStatus)
UNUSED(fmi2GetStatus) UNUSED(fmi2GetString) UNUSED(fmi2GetStringStatus)
UNUSED(fmi2SerializeFMUstate) UNUSED(fmi2SerializedFMUstateSize) UNUSED(fmi2SetFMUstate)
UNUSED(fmi2SetRealInputDerivatives) UNUSED(fmi2SetString)
#else
UNUSED(fmi3ActivateModelPartition) UNUSED(fmi3CompletedIntegratorStep)
UNUSED(fmi3DeserializeFMUState) UNUSED(fmi3EnterConfigurationMode)
UNUSED(fmi3EnterContinuousTimeMode) UNUSED(fmi3EnterEventMode) UNUSED(fmi3EnterStepMode)
UNUSED(fmi3EvaluateDiscreteStates) UNUSED(fmi3ExitConfigurationMode) UNUSED(fmi3FreeFMUState)
UNUSED(fmi3GetAdjointDerivative) UNUSED(fmi3GetBinary) UNUSED(fmi3GetClock)
UNUSED(fmi3GetContinuousStateDerivatives) UNUSED(fmi3GetContinuousStates)
UNUSED(fmi3GetDirectionalDerivative) UNUSED(fmi3GetEventIndicators) UNUSED(fmi3GetFMUState)
UNUSED(fmi3GetFloat32) UNUSED(fmi3GetInt16) UNUSED(fmi3GetInt64) UNUSED(fmi3GetInt8)
UNUSED(fmi3GetIntervalDecimal) UNUSED(fmi3GetIntervalFraction)
UNUSED(fmi3GetNominalsOfContinuousStates) UNUSED(fmi3GetNumberOfContinuousStates)
UNUSED(fmi3GetNumberOfEventIndicators) UNUSED(fmi3GetNumberOfVariableDependencies)
UNUSED(fmi3GetOutputDerivatives) UNUSED(fmi3GetShiftDecimal) UNUSED(fmi3GetShiftFraction)
UNUSED(fmi3GetString) UNUSED(fmi3GetUInt16) UNUSED(fmi3GetUInt32) UNUSED(fmi3GetUInt64)
UNUSED(fmi3GetUInt8) UNUSED(fmi3GetVariableDependencies) NONE(fmi3InstantiateModelExchange)
NONE(fmi3InstantiateScheduledExecution) UNUSED(fmi3SerializeFMUState)
UNUSED(fmi3SerializedFMUStateSize) UNUSED(fmi3SetBinary) UNUSED(fmi3SetClock)
UNUSED(fmi3SetContinuousStates) UNUSED(fmi3SetFMUState) UNUSED(fmi3SetFloat32) UNUSED(fmi3SetInt16)
UNUSED(fmi3SetInt64) UNUSED(fmi3SetInt8) UNUSED(fmi3SetIntervalDecimal)
UNUSED(fmi3SetIntervalFraction) UNUSED(fmi3SetShiftDecimal) UNUSED(fmi3SetShiftFraction)
UNUSED(fmi3SetString) UNUSED(fmi3SetTime) UNUSED(fmi3SetUInt16) UNUSED(fmi3SetUInt32)
UNUSED(fmi3SetUInt64) UNUSED(fmi3SetUInt8) UNUSED(fmi3UpdateDiscreteStates)
#endif
