"""A bound socket for a server of ours, and the addresses under which it is reached."""

import contextlib
import errno
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
        except (OSError, OverflowError, TypeError, ValueError) as error:  # the last two: a name that can be none
            reason = getattr(error, "strerror", None) or str(error)
            is_port = isinstance(error, OverflowError) or getattr(error, "errno", 0) in (errno.EADDRINUSE, errno.EACCES)
            mend = f"choose another with {'--port' if is_port else '--host'}"
            raise BadInput(f"{host}:{port}: cannot be listened on ({reason}); {mend}") from None
        listener.listen(2048)
        yield listener


def bound_to(listener: socket.socket) -> str:
    """The IP address that it listens on, by whatever name that was given."""
    return str(listener.getsockname()[0])


def address_of(listener: socket.socket) -> str:
    """The URL under which the socket is reached from this machine."""
    address = bound_to(listener)
    here = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(address, address)
    return f"http://{in_url(here)}:{listener.getsockname()[1]}"


def in_url(address: str) -> str:
    """An IP address as a URL has it: version 6 in brackets."""
    return f"[{address}]" if ":" in address else address


def is_loopback(address: str) -> bool:
    """Whether only this machine can connect to what listens on an IP address."""
    found = ipaddress.ip_address(address)
    return (getattr(found, "ipv4_mapped", None) or found).is_loopback


def reached_by(address: str, url: str) -> list[str]:
    """Where others on the network find a server that listens on `address`, and on this machine is at `url`."""
    families = {"0.0.0.0": [socket.AF_INET], "::": [socket.AF_INET, socket.AF_INET6]}.get(address, [])
    behind = url.rpartition(":")[2]  # port and path
    found = [one for family in families for one in own_addresses(family)]
    return [f"http://{in_url(one)}:{behind}" for one in found] or [url]


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
