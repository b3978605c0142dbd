"""Who is told how far a computation is: nobody, a function, or a bar of tqdm."""


class _Called:
    def __init__(self, function):
        self.function = function

    def __call__(self, fraction):
        self.function(fraction)

    def close(self):
        pass


class _Bar:
    def __init__(self, name):
        try:
            from tqdm.auto import tqdm
        except ImportError as error:
            raise ImportError("progress=True needs tqdm: apt-get install python3-tqdm") from error
        self.bar = tqdm(total=1.0, desc=name, bar_format="{desc}: {percentage:3.0f} %|{bar}| {elapsed}<{remaining}")

    def __call__(self, fraction):
        self.bar.update(fraction - self.bar.n)

    def close(self):
        self.bar.close()


def listener(progress, name):
    """What is called with the fraction done of `name` and closed at the end; None: nobody asked."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _Bar(name)
    if not callable(progress):
        raise TypeError(f"progress: a {type(progress).__name__}, must be True, False or a function of the fraction done")
    return _Called(progress)
