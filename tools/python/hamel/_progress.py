"""A progress bar, by tqdm if that is installed."""

import sys
from collections.abc import Callable


def bar() -> Callable[[float], None]:
    """Returns a function that takes the completed fraction, in [0, 1]."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _plain
    shown = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")

    def report(fraction: float) -> None:
        shown.update(fraction - shown.n)
        if fraction >= 1:
            shown.close()

    return report


def _plain(fraction: float) -> None:
    end = "\n" if fraction >= 1 else ""
    print(f"\r{100 * fraction:5.1f} %", end=end, file=sys.stderr, flush=True)
