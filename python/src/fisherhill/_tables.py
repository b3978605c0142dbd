"""What results have in common: a table, its HTML, and a drawing."""

import html
import math
from types import SimpleNamespace

_ROWS_SHOWN = 20
_COLUMNS_SHOWN = 12


def _imported(module, package, what):
    try:
        return __import__(module, fromlist=["*"])
    except ImportError as error:
        raise ImportError(f"{what} needs {module.split('.')[0]}: apt-get install {package}") from error


def pandas():
    return _imported("pandas", "python3-pandas", "to_dataframe")


def new_axes(axes, count=1):
    """The axes that were given, or new ones below each other."""
    if axes is not None:
        return axes
    pyplot = _imported("matplotlib.pyplot", "python3-matplotlib", "plot")
    figure, axes = pyplot.subplots(count, 1, sharex=count > 1, squeeze=False, figsize=(7, 3.2 * count))
    figure.set_layout_engine("tight")
    return axes[0, 0] if count == 1 else list(axes[:, 0])


def several_axes(axes, count):
    """As many axes as there are panels; one may be given if one is enough."""
    axes = new_axes(axes, count)
    axes = list(axes) if hasattr(axes, "__len__") else [axes]
    if len(axes) != count:
        raise ValueError(f"axes: {len(axes)}, must be {count}")
    return axes


def text_of(value):
    """A cell as people read it."""
    if value is None:
        return "–"
    if isinstance(value, bool) or type(value).__name__ == "bool_":
        return "yes" if value else "no"
    if isinstance(value, (list, tuple)):
        return ", ".join(text_of(one) for one in value)
    try:
        number = float(value)
    except (TypeError, ValueError):
        return str(value)
    if isinstance(value, str):
        return value
    return "–" if math.isnan(number) else f"{number:.4g}"


def _row(cells, tag="td"):
    return "<tr>" + "".join(f"<{tag}>{html.escape(text_of(one))}</{tag}>" for one in cells) + "</tr>"


def html_of(title, sentence, columns):
    names = list(columns)[:_COLUMNS_SHOWN]
    rows = list(zip(*(columns[name] for name in names)))
    count = len(rows)
    lines = [f"<p><b>{html.escape(title)}</b> {html.escape(sentence)}</p>"]
    if names:
        lines += ["<table>", "<thead>" + _row(names, "th") + "</thead>", "<tbody>"]
        lines += [_row(row) for row in rows[:_ROWS_SHOWN]]
        lines += ["</tbody>", "</table>"]
    left = []
    if count > _ROWS_SHOWN:
        left.append(f"{count - _ROWS_SHOWN} more rows")
    if len(columns) > _COLUMNS_SHOWN:
        left.append(f"{len(columns) - _COLUMNS_SHOWN} more columns")
    if left:
        lines.append(f"<p>… {' and '.join(left)}</p>")
    return "\n".join(lines)


def frame_of(columns, index):
    frame = pandas().DataFrame(columns)
    return frame.set_index(index) if index else frame


class Table(SimpleNamespace):
    """A result that is a table: `_columns()` gives {name: values}, the first is the index."""

    _indexed = True

    def _columns(self):
        raise NotImplementedError

    def _sentence(self):
        return ""

    def to_dataframe(self):
        columns = self._columns()
        return frame_of(columns, next(iter(columns)) if self._indexed else None)

    def _repr_html_(self):
        return html_of(type(self).__name__, self._sentence(), self._columns())


class Plotted(Table):
    """A table with a drawing."""

    def plot(self, axes=None):
        raise NotImplementedError


class Rows(list):
    """Results of one kind, a row each; members that are no single value are left out."""

    def _columns(self):
        single = (str, bool, int, float, type(None))
        columns = {}
        for name in vars(self[0]) if self else []:
            values = [getattr(row, name) for row in self]
            if all(isinstance(one, single) for one in values):
                columns[name] = values
            elif all(isinstance(one, list) and all(isinstance(word, str) for word in one) for one in values):
                columns[name] = [", ".join(one) for one in values]
        return columns

    def to_dataframe(self):
        columns = self._columns()
        return frame_of(columns, next(iter(columns), None))

    def _repr_html_(self):
        return html_of(type(self).__name__, f"{len(self)} rows", self._columns())


class PlottedRows(Rows):
    """Rows with a drawing."""

    def plot(self, axes=None):
        raise NotImplementedError
