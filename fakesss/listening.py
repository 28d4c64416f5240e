"""A bound socket for a server of ours, and the addresses under which it is reached."""

import contextlib
import ipaddress
import socket
from collections.abc import Iterator

from fakesss.problem import BadInput

SOMEWHERE = {socket.AF_INET: "192.0.2.1", socket.AF_INET6: "2001:db8::1"}
"""Addresses of nobody (RFC 5737, RFC 3849): which of ours would send to them says by which others reach us."""


@contextlib.contextmanager
def listening(host: str, port: int) -> Iterator[socket.socket]:
    """A bound socket, or `BadInput` in one sentence."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio turns Nagle's algorithm off only where it sees the protocol's number; with it a reply takes 40 ms more
    with socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((host, port))
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise BadInput(f"{host}:{port}: cannot be listened on ({reason}); choose another with --port") from None
        listener.listen(2048)
        yield listener


def address_of(listener: socket.socket) -> str:
    """The URL under which the socket is reached from this machine."""
    host, port = listener.getsockname()[:2]
    host = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{host}:{port}"


def is_loopback(host: str) -> bool:
    """Whether only this machine can connect."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def reached_by(host: str, url: str) -> list[str]:
    """Where others on the network find a server that listens on `host`, and on this machine is at `url`."""
    families = {"0.0.0.0": [socket.AF_INET], "::": [socket.AF_INET, socket.AF_INET6]}.get(host, [])
    behind = url.rpartition(":")[2]  # port and path
    found = [address for family in families for address in own_addresses(family)]
    return [f"http://{f'[{address}]' if ':' in address else address}:{behind}" for address in found] or [url]


def own_addresses(family: socket.AddressFamily) -> list[str]:
    """This machine's on its networks: the one that leads outside first, then those that its own name has."""
    found = []
    with contextlib.suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as probe:  # no such network
        probe.connect((SOMEWHERE[family], 9))  # of a datagram's socket: nothing is sent
        found.append(probe.getsockname()[0])
    with contextlib.suppress(OSError):  # a name that nobody knows
        found += [str(known[4][0]) for known in socket.getaddrinfo(socket.gethostname(), None, family)]
    public = [address for address in dict.fromkeys(found) if "%" not in address]
    return [address for address in public if not ipaddress.ip_address(address).is_loopback]
