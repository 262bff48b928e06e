"""A web server on 127.0.0.1 for the files of one folder, and for no others."""

from __future__ import annotations

from collections.abc import Iterable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from codegen.errors import UserError

HOST = "127.0.0.1"
POLL = 0.05
"""Seconds after which a server in a thread of its own sees that it is to end."""
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".bin": "application/octet-stream",
}
"""Content type by ending; stages are plain text."""
PLAIN = "text/plain; charset=utf-8"


def open_server(folder: Path, names: Iterable[str], port: int = 0) -> ThreadingHTTPServer:
    """A server of the files `names` in `folder`, not yet running; port 0 takes one that is free.

    errors  UserError where the port is taken or not allowed
    """
    served = {f"/{name}": folder / name for name in names}
    served["/"] = folder / "index.html"

    class Handler(BaseHTTPRequestHandler):
        """Answers GET and HEAD for the names in the table; a path is looked up there, never walked."""

        server_version = "vair"
        sys_version = ""
        protocol_version = "HTTP/1.1"

        def do_GET(self) -> None:
            self._answer(with_body=True)

        def do_HEAD(self) -> None:
            self._answer(with_body=False)

        def _answer(self, with_body: bool) -> None:
            path = served.get(unquote(urlsplit(self.path).path))
            try:
                data = path.read_bytes() if path is not None else None
            except OSError:
                data = None
            if path is None or data is None:
                self.send_error(HTTPStatus.NOT_FOUND, "There is no such file")
                return
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", KINDS.get(path.suffix, PLAIN))
            self.send_header("Content-Length", str(len(data)))
            self.send_header("Cache-Control", "no-cache")
            self.send_header("X-Content-Type-Options", "nosniff")
            self.end_headers()
            if with_body:
                self.wfile.write(data)

        def log_message(self, format: str, *args: Any) -> None:
            """Says nothing: the page tells what is wrong."""

    try:
        return ThreadingHTTPServer((HOST, port), Handler)
    except (OSError, OverflowError) as error:
        reason = error.strerror if isinstance(error, OSError) else "ports end at 65535"
        raise UserError(f"cannot serve on {HOST}:{port}: {reason}") from None


def address(server: ThreadingHTTPServer) -> str:
    """The address that the page has."""
    return f"http://{HOST}:{server.server_port}/"
