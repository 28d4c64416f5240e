"""A participant for the tests: the browser's endpoints, one call each, nothing repeated and nothing hidden."""

import weakref
from typing import Any

import httpx

JSON = {"Accept": "application/json"}
ABOUT = {"age": "25-34", "background": "as a hobby", "vision": "normal"}


class Participant:
    """Somebody on their way through the survey at `url`; `state` is the last page as a dict."""

    def __init__(self, url: str, query: str = "") -> None:
        self.client = httpx.Client(base_url=url, headers=JSON, follow_redirects=True, timeout=60)
        weakref.finalize(self, self.client.close)
        self.state: dict[str, Any] = self.client.get(f"/{query}").json()
        self.here: str = self.state["here"]

    def post(self, step: str, **fields: str) -> dict[str, Any]:
        """Send a form; the page after it."""
        response = self.client.post(f"{self.here}/{step}", json=fields)
        assert response.status_code == 200, response.text
        self.state = response.json()
        return self.state

    def consent(self) -> "Participant":
        """Past the first page: the session is started."""
        self.post("consent", **self.state.get("external", {}))
        return self

    def to_trials(self) -> "Participant":
        """Everything up to the first picture that counts."""
        self.consent()
        self.post("about", **ABOUT)
        self.post("screen")
        self.post("instructions")
        while self.state["step"] == "practice":
            self.rate()
        self.post("ready")
        assert self.state["step"] == "trials"
        return self

    def answers(self, rating: int = 4, **changes: Any) -> dict[str, Any]:
        """The body that the browser sends for the picture that is due."""
        questions = self.state["questions"]
        return {
            "place": self.state["place"],
            "submission": f"submission-{self.state['place']}",
            "stimulus_sha256": self.state["picture"]["sha256"],
            "since_shown_ms": 3000.0,
            "answers": [
                {"question": question["name"], "rating": rating, "rt_ms": 1000.0 + index}
                for index, question in enumerate(questions)
            ],
            "display": {
                "device_pixel_ratio": 1,
                "zoom": 1,
                "drawn_width_px": self.state["picture"]["width"],
                "window_width_px": 1280,
                "window_height_px": 800,
                "focus_lost_ms": 0,
            },
            **changes,
        }

    def send(self, body: dict[str, Any]) -> httpx.Response:
        """Post answers as they are."""
        return self.client.post(f"{self.here}/ratings", json=body)

    def rate(self, rating: int = 4) -> dict[str, Any]:
        """Answer the picture that is due and go on; what the server says it saved."""
        response = self.send(self.answers(rating))
        assert response.status_code == 200, response.text
        reply: dict[str, Any] = response.json()
        self.state = reply["next"]
        return reply

    def to_end(self) -> str:
        """Rate what is left; the completion code."""
        while self.state["step"] == "trials":
            self.rate()
        if self.state["step"] == "comments":
            self.post("comments", comments="")
        return str(self.state["completion_code"])
