"""A case with the compensation that it is run with."""

from dataclasses import replace

from uictest.plans.scenario import Case, Scenario


def identified(case: Case) -> Case:
    """Return a case whose compensation, where it is to be identified, is: for its caliper, brake and sensors.

    The same rig gives the same numbers, in every process and in every order. What is identified is what the
    setting of the compensation uses; of a train, that of every car. It takes up to some minutes, once for
    each distinct rig.

    Raises:
        UnsuitableRecordError: the bench cannot identify a compensation for the rig; the message says why.
    """
    scenario = _identified(case.scenario)
    if case.train is not None:
        scenarios = tuple(map(_identified, case.train.scenarios))
        return replace(case, scenario=scenario, train=replace(case.train, scenarios=scenarios))
    return case if scenario is case.scenario else replace(case, scenario=scenario)


def _identified(scenario: Scenario) -> Scenario:
    rig = scenario.rig
    if not rig.compensation_model.to_identify or rig.topology != "one-caliper":
        return scenario
    # It brings the bench and the identification, which few stops need.
    from uictest.rig.bench.identified_rig import identified_compensation

    model = identified_compensation(scenario)
    return scenario.model_copy(update={"rig": rig.model_copy(update={"compensation_model": model})})
