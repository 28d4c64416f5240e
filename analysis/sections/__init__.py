"""The parts of the report between "Results first" and the sentences to paste, each computed, drawn and worded in one
place: a function from `Evidence` to a `Section`, or to None where it has nothing to say."""
