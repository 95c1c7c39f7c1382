"""Prepared statements: compiled once by SQLAlchemy, then given to the driver past it.

What every answer needs is run so: building, looking up and wrapping one statement costs SQLAlchemy
some hundred microseconds, of which the database itself uses ten. The tables' own types convert what
goes in and comes out, so both kinds of databases read and write as they do elsewhere.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Delete, Float, Insert, Select, Table, Update
from sqlalchemy.engine import Dialect
from sqlalchemy.types import TypeEngine

from study.data.schema import Base

Convert = Callable[[Any], Any]
Values = Mapping[str, Any]


@dataclass(frozen=True)
class _Ready:
    """A statement in one dialect: its text, what becomes of each value, and of each column."""

    text: str
    names: tuple[str, ...] | None
    fixed: Values
    into: tuple[tuple[str, Convert], ...]
    out: tuple[tuple[int, Convert], ...]

    def parameters(self, values: Values) -> Any:
        """Return the values as the driver takes them."""
        given = {**self.fixed, **values}
        for name, convert in self.into:
            given[name] = convert(given[name])
        return given if self.names is None else [given[name] for name in self.names]


def table_of(kind: type[Base]) -> Table:
    """Return the table of a class of the schema."""
    return Base.metadata.tables[kind.__tablename__]


class Prepared:
    """A statement whose values are named by ``bindparam``; it may run on both kinds of databases.

    Rows are named tuples of the selected columns, or of those that a change returns. Lists of
    values (``in_``) cannot be bound.
    """

    def __init__(self, statement: Select[Any] | Insert | Update | Delete) -> None:
        self.writes = not isinstance(statement, Select)
        self._statement = statement
        self._ready: dict[str, _Ready] = {}
        self._columns = tuple(statement.exported_columns)
        self._make = _row_maker([str(column.key) for column in self._columns])

    def send(self, connection: Any, dialect: Dialect, values: Values) -> Any:
        """Run it on a driver's connection and return the driver's cursor, for ``rows``."""
        ready = self._ready.get(dialect.name) or self._prepare(dialect)
        return connection.execute(ready.text, ready.parameters(values))

    def rows(self, cursor: Any, dialect: Dialect) -> list[Any]:
        """Read what a cursor of ``send`` has found."""
        if not self._columns:
            return []
        make, out = self._make, self._ready[dialect.name].out
        return [make(_converted(row, out)) for row in cursor.fetchall()]

    def _prepare(self, dialect: Dialect) -> _Ready:
        compiled = self._statement.compile(dialect=dialect)
        binds = {compiled.bind_names[bind]: bind.type for bind in compiled.bind_names}
        ready = _Ready(
            text=str(compiled),
            names=tuple(compiled.positiontup or ()) if compiled.positional else None,
            fixed={name: value for name, value in compiled.params.items() if value is not None},
            into=_converters(list(binds.items()), dialect, _into),
            out=_converters([(n, c.type) for n, c in enumerate(self._columns)], dialect, _out),
        )
        self._ready[dialect.name] = ready
        return ready


def _row_maker(names: Sequence[str]) -> Callable[[Sequence[Any]], Any]:
    """Return what makes a named tuple of a row; which columns there are only the statement says."""
    make: Any = namedtuple
    found: Callable[[Sequence[Any]], Any] = make("Row", names)._make
    return found


def _converted(row: Sequence[Any], out: tuple[tuple[int, Convert], ...]) -> Sequence[Any]:
    if not out:
        return row
    cells = list(row)
    for place, convert in out:
        if cells[place] is not None:
            cells[place] = convert(cells[place])
    return cells


def _into(kind: TypeEngine[Any], dialect: Dialect) -> Convert | None:
    return kind.bind_processor(dialect)


def _out(kind: TypeEngine[Any], dialect: Dialect) -> Convert | None:
    if isinstance(kind, Float):  # drivers read them as they are; PostgreSQL's asks for a number
        return None
    return kind.result_processor(dialect, None)


def _converters(
    kinds: Sequence[tuple[Any, TypeEngine[Any]]],
    dialect: Dialect,
    choose: Callable[[TypeEngine[Any], Dialect], Convert | None],
) -> tuple[tuple[Any, Convert], ...]:
    found = [(name, choose(kind.dialect_impl(dialect), dialect)) for name, kind in kinds]
    return tuple((name, convert) for name, convert in found if convert is not None)
