"""What callers hand over, as the library takes it: texts, matrices, parameters, arrays."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Mapping
from ctypes import POINTER, c_char_p
from typing import Any, Optional, Union

import numpy
from numpy.typing import NDArray

from ._declarations import Parameter, ParameterType

Path = Union[str, bytes, os.PathLike]
Parameters = Optional[Mapping[str, Any]]  # {"rgb reflectance": (1, 0, 0)}
Poll = Optional[Callable[[], None]]
_PARAMETER_TYPES = {each.name.lower(): each for each in ParameterType}


def encoded(value):
    made = None if value is None else os.fsencode(value)
    if made and b"\0" in made:
        raise ValueError("a text with a NUL in it cannot be handed on")
    return made


def ends_address(value, kept):
    """As matrix_address of one matrix or several, (count, 4, 4), and how many there are."""
    if value is None:
        return None, 1
    rows = numpy.require(value, numpy.float64, "CA")
    if rows.size == 0 or rows.size % 16 != 0 or (rows.size > 16 and rows.shape[-2:] != (4, 4)):
        raise ValueError("the matrices at the end are 4 x 4 or count x 4 x 4 numbers")
    kept.append(rows)
    return rows.ctypes.data, rows.size // 16


def matrix_address(value, kept):
    """The address of 16 numbers, row by row, which `kept` keeps; None: no matrix."""
    if value is None:
        return None
    rows = numpy.require(value, numpy.float64, "CA")
    if rows.size != 16:
        raise ValueError("a matrix has 4 x 4 numbers")
    kept.append(rows)
    return rows.ctypes.data


def _strings(values, kept):
    array = (c_char_p * len(values))(*[encoded(value) for value in values])
    kept.append(array)
    return ctypes.cast(array, POINTER(c_char_p))


def _parameter(declaration, value, kept):
    """One of {"rgb reflectance": (1, 0, 0)}; what it points to is kept by `kept`."""
    words = declaration.split()
    if len(words) != 2 or words[0] not in _PARAMETER_TYPES:
        raise ValueError(f'"{declaration}" is no "type name" of a parameter')
    made = Parameter(name=words[1].encode(), type=_PARAMETER_TYPES[words[0]])
    if isinstance(value, (str, os.PathLike)):
        value = [value]
    if isinstance(value, (list, tuple)) and value and isinstance(value[0], (str, os.PathLike)):
        made.count, made.strings = len(value), _strings(value, kept)
        return made
    array = numpy.asarray(value)
    if words[0] == "bool":
        array, field = array.astype(numpy.bool_), "bools"
    elif words[0] == "integer":
        whole = array.astype(numpy.int32)
        if not numpy.array_equal(whole, array):
            raise ValueError(f'"{declaration}": the values are no integers of 32 bits')
        array, field = whole if array.dtype != numpy.int32 else array, "integers"
    elif array.dtype == numpy.float32:
        field = "floats"
    else:
        array, field = array.astype(numpy.float64, copy=False), "doubles"
    array = numpy.require(array, requirements="CA")
    kept.append(array)
    made.count = array.size
    setattr(made, field, array.ctypes.data)
    return made


def parameter_array(values, kept):
    items = [_parameter(declaration, value, kept) for declaration, value in (values or {}).items()]
    array = (Parameter * max(len(items), 1))(*items)
    kept.append(array)
    return array, len(items)


def vertices(count: int) -> NDArray[numpy.float32]:
    """An array of zeros, (count, 3) of 32-bit floats, with the room behind it that a borrowed P needs."""
    return numpy.zeros(3 * count + 1, numpy.float32)[:-1].reshape(count, 3)


def _has_room(array):
    """Whether 4 bytes behind an array belong to the array that it is a view of."""
    whole = array
    while isinstance(whole.base, numpy.ndarray):
        whole = whole.base
    return array.ctypes.data + array.nbytes + 4 <= whole.ctypes.data + whole.nbytes


def check_borrowed(parameters):
    for declaration, dtype in (("point3 P", "float32"), ("point2 uv", "float32"), ("integer indices", "int32")):
        array = parameters.get(declaration)
        if array is None:
            continue
        if (not isinstance(array, numpy.ndarray) or array.dtype != dtype or not array.flags.c_contiguous
                or not array.flags.aligned):
            raise ValueError(f'"{declaration}": a borrowed array is of numpy, contiguous, aligned and of {dtype}')
        if declaration == "point3 P" and not _has_room(array):
            raise ValueError('"point3 P": a borrowed array has room behind it, as those of vertices() have')
