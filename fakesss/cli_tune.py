"""The command that changes a scene while one looks at it: tune."""

import os
import shlex
import sys
from urllib.parse import urlsplit

import click

from fakesss.cli import AS_JSON, commands, done, say
from fakesss.cli_picture import scene_named
from fakesss.listening import in_url, is_loopback, reached_by


@commands.command()
@click.argument("scene", default="figure")
@click.option("--host", default="127.0.0.1", show_default=True, help="0.0.0.0: reachable from other machines.")
@click.option("--port", default=8010, show_default=True, type=click.IntRange(0, 65535), help="0: any free one.")
@click.option("--set", "changes", multiple=True, metavar="PATH=VALUE", help="Change one field of the scene.")
@click.option("--size", metavar="WxH", help="Pixels, for example 512x512.")
@AS_JSON
def tune(scene: str, host: str, port: int, changes: tuple[str, ...], size: str | None, as_json: bool) -> None:
    """Change SCENE in the browser while looking at it: a TOML file, a mesh file or a built-in object.

    Prints an address that holds a secret; whoever knows it can use the tuner until it is stopped with Ctrl-C. Scenes
    and studies that are kept go into the current folder.

    Example: fakesss tune bunny.ply --set material.backlight=0.8
    """
    from fakesss.tuner.serve import serve
    from stimuli.sweep import write_sweep

    described = scene_named(scene, changes, size)

    def announce(url: str, address: str) -> None:
        done({"url": url, "scene_sha256": described.sha256()}, as_json, url)
        sys.stdout.flush()  # a pipe would keep it until the end
        for hint in filter(None, (ssh_hint(url), network_hint(address, url))):
            say(hint)
        say("Open this address in a browser. Ctrl-C stops the tuner.")

    serve(described, host, port, write_sweep, announce)


def ssh_hint(url: str) -> str:
    """What to type on the machine that one sits at, if this one is reached by SSH and no other way leads to `url`."""
    connection = os.environ.get("SSH_CONNECTION", "").split()  # client's address and port, server's address and port
    place = urlsplit(url)
    if len(connection) != 4 or not place.hostname or not is_loopback(place.hostname):
        return ""
    there = f"127.0.0.1:{place.port}"  # where ssh listens
    also = "" if place.hostname in ("127.0.0.1", "::1") else f"  and open http://{there}{place.path} there"
    forward = shlex.quote(f"{place.port}:{in_url(place.hostname)}:{place.port}")  # brackets are patterns to a shell
    return f"You are here by SSH: on your own machine run  ssh -L {forward} {connection[2]}{also}"


def network_hint(address: str, url: str) -> str:
    """Who can reach it, if the IP address that is listened on is more than this machine."""
    if is_loopback(address):
        return ""
    there = " or ".join(reached_by(address, url))
    means = "whoever has the address can use this machine's processor and write scenes and studies here"
    return f"Other machines reach it at {there}, unencrypted: {means}."
