"""A real small disk that a test can fill: a tmpfs in a mount namespace of its own, without changing this machine's."""

import contextlib
import errno
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

ALLOW = (
    "a small disk cannot be mounted here ({reason}): run the tests as root, or allow user namespaces "
    "(sysctl -w user.max_user_namespaces=10000 kernel.apparmor_restrict_unprivileged_userns=0; in a container "
    "--cap-add SYS_ADMIN --security-opt seccomp=unconfined --security-opt apparmor=unconfined)"
)
WAYS = (
    ((), ()),  # the right of root
    (("--map-root-user",), ("--user", "--preserve-credentials")),  # everybody's, in a user namespace
)
"""What unshare and nsenter are told besides --mount."""

HOLD = 'mount -t tmpfs -o size="$2",mode=755 fakesss "$1" && echo mounted && read -r _'
"""Mounts, says so, and holds the namespace until its standard input is closed."""


class SmallDisk:
    """A disk of `size` bytes, seen at `path` by programs that run with `prefix` before their command.

    The test itself sees it at `seen`: a path through /proc, good for files, not for SQLite, which resolves it.
    """

    def __init__(self, path: Path, size: int) -> None:
        self.path = path
        for unshare, enter in WAYS:  # noqa: B007 - the way that worked is the one to enter by
            self.holder = subprocess.Popen(
                ["unshare", "--mount", *unshare, "sh", "-c", HOLD, "sh", str(path), str(size)],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            )  # fmt: skip
            assert self.holder.stdout is not None
            if self.holder.stdout.readline() == "mounted\n":
                break
            reason = self.holder.communicate()[1].partition("\n")[0]
        else:
            raise AssertionError(ALLOW.format(reason=reason))
        self.prefix = ["nsenter", "--target", str(self.holder.pid), "--mount", "--root", *enter]
        self.seen = Path(f"/proc/{self.holder.pid}/root{path}")
        self.filler = self.seen / "filler"

    def fill(self, leave: int = 0) -> None:
        """Write until no byte more goes on it; then give `leave` bytes back, whole pages of 4096."""
        with self.filler.open("ab", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(4096))
            except OSError as error:
                if error.errno != errno.ENOSPC:
                    raise
            file.truncate(max(0, file.tell() - leave))

    def free(self) -> None:
        """Take away what `fill` wrote."""
        self.filler.unlink()

    def read_only(self) -> None:
        """Nothing can be written any more. The kernel allows it while no file there is open for writing."""
        self.remount("ro")

    def writable(self) -> None:
        """The opposite of `read_only`."""
        self.remount("rw")

    def remount(self, option: str) -> None:
        """Change the mounted disk's options."""
        command = [*self.prefix, "mount", "-o", f"remount,bind,{option}", str(self.path)]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, f"{done.stderr.strip()}; is a file there open for writing?"

    def close(self) -> None:
        """The disk is gone with the last program that sees it."""
        self.holder.communicate("end\n")


@contextlib.contextmanager
def small_disk(mount_point: Path, *, size: int = 4_000_000, copy_of: Path | None = None) -> Iterator[SmallDisk]:
    """A `SmallDisk` at the new folder `mount_point`, with the files of the folder `copy_of` on it."""
    mount_point.mkdir()
    disk = SmallDisk(mount_point, size)
    try:
        if copy_of is not None:
            shutil.copytree(copy_of, disk.seen, dirs_exist_ok=True)
        yield disk
    finally:
        disk.close()
