"""Plain Python on plain numbers: an eighth of the time that it takes on numpy's records."""

from types import SimpleNamespace

import numpy as np

from uictest.rig.model.trace import Trace


def on_numbers(function, *arguments):
    """Call a function of the rig in plain Python, and enter into the records what it has left."""
    records = [each for each in arguments if getattr(each, "dtype", None) is not None and each.dtype.names]
    traces = [each for each in arguments if isinstance(each, Trace)]
    plain = {id(each): _numbers(each) for each in records}
    plain |= {id(trace): Trace(*map(_blank_samples, trace)) for trace in traces}
    result = function(*(plain.get(id(each), each) for each in arguments))
    for record in records:
        _write_back(plain[id(record)], record)
    for trace in traces:
        for table, own in zip(trace, plain[id(trace)], strict=True):
            for name in table.dtype.names:
                table[name] = np.reshape([getattr(each, name, 0.0) for each in own.flat], table.shape)
    return result


def _blank_samples(table):
    """Rows for samples that are written once each."""
    rows = np.empty(table.shape, object)
    rows.flat = [SimpleNamespace() for _ in range(table.size)]
    return rows


def _numbers(record):
    if record.shape:
        return [_numbers(each) for each in record]
    return SimpleNamespace(**{name: record[name].tolist() for name in record.dtype.names})


def _write_back(numbers, record):
    if record.shape:
        for place, each in enumerate(numbers):
            _write_back(each, record[place])
    else:
        for name in record.dtype.names:
            record[name] = getattr(numbers, name)
