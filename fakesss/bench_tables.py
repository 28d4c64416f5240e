"""The figures of `fakesss bench` as two tables in Markdown, after tables 4.1 and 4.2 of the thesis."""

from collections.abc import Mapping, Sequence
from typing import Any

from fakesss.bench import THESIS

DRAWING = (
    "faces",
    "direct ms",
    "technique ms",
    "ratio",
    "unculled",
    "peeled",
    "approximate",
    "own",
    "thesis",
    "difference",
)
RATIOS = ("ratio", "unculled_ratio", "peeled_ratio", "approximate_ratio", "own_ratio")
BAKING = ("faces", "hierarchy ms", "bake s", "Mrays/s", "bare Embree", "share", "share of work", "cores busy", "bare")


def tables(result: Mapping[str, Any]) -> str:
    """Both tables, what the columns mean, and whose figures they are."""
    machine = result["machine"]
    rows = result["rows"]
    return "\n".join(
        [
            f"{machine['gl_renderer']}, {machine['gl_version']}; {machine['cores']} cores, {machine['processor']}",
            "",
            "Drawing: cost beside direct light with back faces culled",
            "",
            *table(DRAWING, [drawing(row) for row in rows]),
            "",
            "Baking occlusion",
            "",
            *table(BAKING, [baking(row) for row in rows]),
            "",
            f"Method: {result['method']}.",
        ]
    )


def drawing(row: Mapping[str, Any]) -> list[str]:
    """One row of the first table; the thesis's ratio is for its object of about as many faces."""
    thesis = next((ratio for faces, ratio in THESIS.items() if abs(row["faces"] / faces - 1) < 0.05), None)
    return [
        f"{row['faces']:,}",
        f"{row['direct_ms']:.1f}",
        f"{row['technique_ms']:.1f}",
        *(f"{row[name]:.2f}" for name in RATIOS),
        "" if thesis is None else f"{thesis:.1f}",
        f"{row['largest_difference']}/255",
    ]


def baking(row: Mapping[str, Any]) -> list[str]:
    """One row of the second table."""
    return [
        f"{row['faces']:,}",
        f"{row['bvh_ms']:.0f}",
        f"{row['ao_seconds']:.2f}",
        f"{row['ao_mrays_per_s']:.1f}",
        f"{row['embree_mrays_per_s']:.1f}",
        f"{row['ao_mrays_per_s'] / row['embree_mrays_per_s']:.0%}",
        f"{row['ao_share_of_work']:.0%}",
        f"{row['ao_cores_busy']:.2f}",
        f"{row['embree_cores_busy']:.2f}",
    ]


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a Markdown table, columns padded so that it reads well as text too."""
    widths = [max(len(row[column]) for row in (head, *rows)) for column in range(len(head))]
    padded = ["| " + " | ".join(c.rjust(w) for c, w in zip(row, widths, strict=True)) + " |" for row in (head, *rows)]
    return [padded[0], "|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|", *padded[1:]]
