"""The pictures, looked up by hash: a path from outside never reaches the file system."""

import hashlib
import logging

from fastapi import APIRouter, Request, Response

from study_server.manifest import Stimulus
from study_server.site import AtSite, sorry

router = APIRouter()
log = logging.getLogger(__name__)

FOREVER = "public, max-age=31536000, immutable"
"""The name is the content's hash, so what is cached under it cannot become wrong."""


def picture_facts(stimulus: Stimulus) -> dict[str, str | int]:
    """What the browser needs to fetch a picture and to be sure that it has it."""
    return {
        "url": f"/picture/{stimulus.sha256}.png",
        "sha256": stimulus.sha256,
        "bytes": stimulus.bytes,
        "width": stimulus.width,
        "height": stimulus.height,
    }


@router.get("/picture/{sha256}.png")
def picture(request: Request, site: AtSite, sha256: str) -> Response:
    """The PNG of this hash, read and hashed again each time: a file changed on disk is never sent."""
    stimulus = site.study.by_hash.get(sha256)
    if stimulus is None:
        return sorry(request, 404, "There is no such picture.")
    headers = {"Cache-Control": FOREVER, "ETag": f'"{sha256}"'}
    if request.headers.get("if-none-match") == headers["ETag"]:
        return Response(status_code=304, headers=headers)
    try:
        data = stimulus.path.read_bytes()
    except OSError as error:
        log.error("%s: cannot be read: %s", stimulus.path, error)
        return sorry(request, 503, "The picture cannot be read just now.")
    if hashlib.sha256(data).hexdigest() != sha256:
        log.error("%s: was changed since the study was built; it is not shown", stimulus.path)
        return sorry(request, 503, "The picture on the server is damaged and is not shown.")
    return Response(data, media_type="image/png", headers=headers)
