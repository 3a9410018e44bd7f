"""Functions of a scenario, evaluated for many cases at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any, Final

from numpy.typing import NDArray

from uictest.core.ensemble import Places, alike, by_way, ensemble
from uictest.plans.scenario import Scenario
from uictest.plans.sweeps import Column, with_values

_CACHE_SIZE: Final = 1_000
"""Results of one function that are cached from block to block: listed values recur, drawn ones do not."""
Settings = Mapping[str, Column]
"""The values of each case of a block, by key."""


@dataclass(frozen=True, slots=True)
class Rejected:
    """In place of a result: why there is none."""

    reason: str


class ScenarioVariants:
    """The scenarios of some cases, each built when it is needed."""

    def __init__(
        self, base: Scenario, settings: Settings, count: int, all_numbers: ScenarioVariants | None = None
    ) -> None:
        self.base = base
        self.settings = settings
        self.count = count
        self._all_numbers = all_numbers
        self._scenarios: dict[int, Scenario] = {}
        self._common: dict[bytes, Scenario] = {}
        self._restricted: dict[tuple[str, ...], ScenarioVariants] = {}

    def restricted_to(self, keys: tuple[str, ...]) -> ScenarioVariants:
        """Return the variants in which only these keys vary.

        If all keys have numbers, one scenario with all of them serves any keys: the others are not read.
        """
        if keys not in self._restricted:
            settings = {key: self.settings[key] for key in keys}
            all_numbers = None if any(numbers is None for numbers in self._numbers) else self
            self._restricted[keys] = ScenarioVariants(self.base, settings, self.count, all_numbers)
        return self._restricted[keys]

    def take(self, places: Places) -> ScenarioVariants:
        """Return the variants of some cases."""
        settings = {key: column.take(places) for key, column in self.settings.items()}
        return ScenarioVariants(self.base, settings, places.size)

    def at(self, place: int) -> Scenario:
        """Return the scenario of one case, kept for those who ask for it again."""
        if place not in self._scenarios:
            self._scenarios[place] = self.build(place)
        return self._scenarios[place]

    def build(self, place: int) -> Scenario:
        """Return the scenario of one case, built anew."""
        return with_values(self.base, {key: column[place].content for key, column in self.settings.items()})

    def texts(self, place: int) -> tuple[str, ...]:
        """Return the values of one case as written."""
        return tuple(texts[place] for texts in self._texts)

    def together(self, places: Places) -> Scenario:
        """Return one scenario for cases of the same group, in which their numbers are ensembles."""
        if self._all_numbers is not None:
            return self._all_numbers.together(places)
        content = places.tobytes()
        if content not in self._common:
            self._common[content] = self._with_ensembles(places)
        return self._common[content]

    def _with_ensembles(self, places: Places) -> Scenario:
        contents = {
            key: column[int(places[0])].content if numbers is None else ensemble(numbers[places])
            for (key, column), numbers in zip(self.settings.items(), self._numbers, strict=True)
        }
        return with_values(self.base, contents)

    def groups(self, *, by_numbers: bool) -> list[Places]:
        """Return the places of cases that have the same values; numbers count only where asked for."""
        columns = zip(self.settings.values(), self._numbers, strict=True)
        codes = (column.codes for column, numbers in columns if by_numbers or numbers is None)
        return alike(codes, self.count)

    @cached_property
    def has_numbers(self) -> bool:
        """Whether any of the values are numbers."""
        return any(numbers is not None for numbers in self._numbers)

    @cached_property
    def _numbers(self) -> list[NDArray[Any] | None]:
        return [column.exact for column in self.settings.values()]

    @cached_property
    def _texts(self) -> list[list[str]]:
        return [column.texts for column in self.settings.values()]


@dataclass(frozen=True)
class ScenarioFunction:
    """A function of a scenario that reads only what lies at, below or above some keys.

    `function` is called with ensembles in place of numbers, unless `by_numbers` says that its result cannot
    hold any: it is then called for each number.
    """

    function: Callable[[Scenario], Any]
    keys: tuple[str, ...]
    """The swept keys that the result depends on."""
    by_numbers: bool = False
    cache: dict[tuple[str, ...], Any] = field(default_factory=dict)

    def results(self, variants: ScenarioVariants) -> Iterator[tuple[Places, Any]]:
        """Yield the result for groups of cases.

        A result is :class:`Rejected` where the function raises ValueError or ArithmeticError.
        """
        own = variants.restricted_to(self.keys)
        together = own.has_numbers and not self.by_numbers
        for group in own.groups(by_numbers=self.by_numbers):
            if together:
                yield from by_way(
                    lambda places: self.function(own.together(places)),
                    lambda place: self._alone(own, place),
                    group,
                )
            else:
                yield group, self._alone(own, int(group[0]))

    def per_case(self, variants: ScenarioVariants) -> list[Any]:
        """Return the result for each case, of a function whose results hold no ensembles."""
        results: list[Any] = [None] * variants.count
        for places, result in self.results(variants):
            if places.size == variants.count:
                return [result] * variants.count
            for place in places.tolist():
                results[place] = result
        return results

    def _alone(self, variants: ScenarioVariants, place: int) -> Any:
        texts = variants.texts(place)
        if texts in self.cache:
            return self.cache[texts]
        try:
            result = self.function(variants.at(place))
        except KeyError as error:  # a value of one key leaves no place for that of another
            result = Rejected(f"{error.args[0]!r}: no such key beside the other values of this case")
        except (ValueError, ArithmeticError) as error:
            result = Rejected(f"{type(error).__name__}: {error}")
        # Several threads come here; nothing is ever removed, so an entry that one thread saw stays.
        if len(self.cache) < _CACHE_SIZE:
            self.cache[texts] = result
        return result


def related_keys(swept: Iterable[str], read: Iterable[str]) -> tuple[str, ...]:
    """Return the swept keys at, below or above one that is read."""
    read = frozenset(read)
    above = {key for other in read for key in _prefixes(other)}
    return tuple(key for key in swept if key in above or not read.isdisjoint(_prefixes(key)))


@cache
def _prefixes(key: str) -> tuple[str, ...]:
    """Return the keys of the sections that a key lies in, and the key itself."""
    words = key.split(".")
    return tuple(".".join(words[:depth]) for depth in range(1, len(words) + 1))
