"""Conversion of results to tables of pandas and xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hamel._hamel import EnsembleResult, Result, Section, StudyResult

if TYPE_CHECKING:
    import pandas
    import xarray


def to_pandas(result: Result) -> pandas.DataFrame:
    import pandas

    columns = [name for name in result.columns if name != "t"]
    frame = pandas.DataFrame(
        {name: result[name] for name in columns}, index=pandas.Index(result.t, name="t")
    )
    units = result.units
    frame.attrs["units"] = {name: units[name] for name in frame.columns}
    frame.attrs["system"] = result.config.system
    return frame


def to_xarray(result: Result) -> xarray.Dataset:
    import xarray

    units = result.units
    data: dict[str, object] = {}
    coords: dict[str, object] = {"t": ("t", result.t, {"units": "s"})}
    for name, columns in result.groups.items():
        if name == "t":
            continue
        if columns == [name]:
            data[name] = ("t", result[name], {"units": units[name]})
            continue
        dimension = f"{name}_column"
        coords[dimension] = columns
        attributes = {"units": ",".join(units[column] for column in columns)}
        data[name] = (("t", dimension), result[name], attributes)
    for velocity in result.names:
        if velocity not in data:
            data[velocity] = ("t", result[velocity], {"units": units[velocity]})
    return xarray.Dataset(data, coords=coords, attrs={"system": result.config.system})


def table_to_pandas(table: StudyResult | EnsembleResult | Section) -> pandas.DataFrame:
    import pandas

    frame = pandas.DataFrame({name: table[name] for name in table.columns})
    frame.attrs["units"] = table.units
    return frame
