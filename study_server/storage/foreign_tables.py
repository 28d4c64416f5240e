"""Whether the tables that a database holds already are ours: another program may call some of its own the same."""

from collections.abc import Iterable

from sqlalchemy import Connection, inspect, select

from fakesss.problem import BadInput
from study_server.storage import schema


def holds_ours(connection: Connection, shown: str) -> bool:
    """Whether our tables are there, of whatever version; False if none is.

    Raises `BadInput` naming the database as `shown` if tables of their names are there and `meta` says nothing of us.
    """
    names = set(inspect(connection).get_table_names()) & set(schema.tables.tables)
    if not names:
        return False
    key, name = schema.meta.c.key, schema.meta.name
    if name not in names or {"key", "value"} - columns_there(connection, name):
        raise foreign(shown, names)
    if connection.scalar(select(key).where(key == "schema_version")) is None:
        raise foreign(shown, names)
    return True


def check_columns(connection: Connection, shown: str) -> None:
    """`BadInput` unless every table has every column that this version reads and writes."""
    for table in schema.tables.sorted_tables:
        if set(table.columns.keys()) - columns_there(connection, table.name):
            raise foreign(shown, [table.name])


def columns_there(connection: Connection, table: str) -> set[str]:
    """The names of its columns."""
    return {column["name"] for column in inspect(connection).get_columns(table)}


def foreign(shown: str, names: Iterable[str]) -> BadInput:
    """The sentence."""
    listed = ", ".join(sorted(names))
    return BadInput(f"{shown}: holds tables of another program ({listed}); give the survey a database of its own")
