"""Notes for the user: what cannot be said to the renderer, each thing once for a picture."""


class Notes:
    """report: called with each new text."""

    def __init__(self, report):
        self._report = report
        self._said = set()

    def say(self, text):
        if text not in self._said:
            self._said.add(text)
            self._report(text)
