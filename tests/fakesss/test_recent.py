from fakesss.recent import Recent


def test_keeps_the_most_recently_used_and_disposes_of_the_rest() -> None:
    gone: list[str] = []
    recent: Recent[str] = Recent(2, dispose=gone.append)
    recent.get("a", lambda: "A")
    recent.get("b", lambda: "B")
    recent.get("a", lambda: "made twice")
    recent.get("c", lambda: "C")
    assert gone == ["B"]
    recent.get("d", lambda: gone.pop() and "D")  # what drops out is gone before the new one is made
    assert gone == ["B"]
    assert recent.get("c", lambda: "made twice") == "C"
    recent.clear()
    assert sorted(gone) == ["B", "C", "D"]
