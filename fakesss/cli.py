"""The `fakesss` command: composes the four packages. Each command imports what it needs when it runs.

The commands themselves stand in `cli_study`, `cli_analysis`, `cli_power`, `cli_picture`, `cli_measure`,
`cli_fit`, `cli_tune` and `cli_survey`.
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import click

from fakesss import __version__
from fakesss.problem import BadInput

Mode = Literal["live", "pilot", "simulated"]
STUDY = click.argument("study", type=click.Path(path_type=Path))
AS_JSON = click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="fakesss")
def commands() -> None:
    """Perceptual translucency studies: pictures, survey and statistics in one folder.

    Example: fakesss new my-study && fakesss run my-study
    """


def main() -> None:
    """Runs the command; bad input is one sentence on standard error and exit code 2."""
    import fakesss.cli_analysis
    import fakesss.cli_fit
    import fakesss.cli_measure
    import fakesss.cli_picture
    import fakesss.cli_power
    import fakesss.cli_study
    import fakesss.cli_survey
    import fakesss.cli_tune  # noqa: F401  (all add their commands)

    try:
        sys.exit(commands(standalone_mode=False) or 0)
    except BadInput as error:
        print(f"fakesss: {error}", file=sys.stderr)
        sys.exit(2)
    except click.ClickException as error:
        name = error.ctx.command_path if isinstance(error, click.UsageError) and error.ctx else "fakesss"
        print(f"fakesss: {error.format_message().rstrip('.')}; see {name} --help", file=sys.stderr)
        sys.exit(2)
    except (KeyboardInterrupt, click.Abort):
        print("fakesss: stopped; what was done is kept, the same command continues", file=sys.stderr)
        sys.exit(130)


def say(text: str) -> None:
    """A message for people; standard output is kept for `--json` documents."""
    print(text, file=sys.stderr)


def done(result: Mapping[str, Any], as_json: bool, text: str) -> None:
    """The command's outcome, as JSON on standard output or as text."""
    print(json.dumps(result, indent=1, ensure_ascii=False) if as_json else text)
