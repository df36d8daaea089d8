"""What is raised where the input is wrong."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input, told as on the command line: where it stands, what it says, the rule it breaks and what to do.

    `file` and `line` are empty and 0 for scenes built in Python; `path` is the field, as in
    "solids.finger.material.young".
    """

    def __init__(
        self,
        message: str,
        file: str = "",
        line: int = 0,
        path: str = "",
        value: str = "",
        rule: str = "",
        remedy: str = "",
    ) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.path = path
        self.value = value
        self.rule = rule
        self.remedy = remedy

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, int, str, str, str, str]]:
        return InputError, (str(self), self.file, self.line, self.path, self.value, self.rule, self.remedy)


class StepFailed(RuntimeError):
    """A run stopped because a step could not be made; `run` holds all that came before it."""

    def __init__(self, message: str, run: object) -> None:
        super().__init__(message)
        self.run = run

    def __reduce__(self) -> tuple[type[StepFailed], tuple[str, object]]:
        return StepFailed, (str(self), self.run)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C stopped a run; `run` holds all that came before it."""

    def __init__(self, message: str, run: object) -> None:
        super().__init__(message)
        self.run = run

    def __reduce__(self) -> tuple[type[Interrupted], tuple[str, object]]:
        return Interrupted, (str(self), self.run)
