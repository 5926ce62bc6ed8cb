"""Undo and redo: a list of states, in which one drag is one step."""


class History:
    """The states before and after the one that is shown."""

    def __init__(self, state):
        self.settled = state
        self.past, self.future = [], []

    def settle(self, state):
        """Note that `state` is what a finished action led to."""
        if state is not self.settled and state != self.settled:
            self.past.append(self.settled)
            self.future.clear()
        self.settled = state

    def undo(self, state):
        """The state one step back from `state`, or `state` if there is none."""
        self.settle(state)
        return self._move(self.past, self.future)

    def redo(self, state):
        """The state one step forward again, or `state` if there is none."""
        self.settle(state)
        return self._move(self.future, self.past)

    def _move(self, source, target):
        if source:
            target.append(self.settled)
            self.settled = source.pop()
        return self.settled
