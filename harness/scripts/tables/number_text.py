"""Numbers as documents show them, and as texts have them."""
import re


def plain(value):
    """Three digits or so: 5.5, 11.6, 120, 1,249."""
    return f"{value:,.1f}" if value < 20 else f"{value:,.0f}"


def interval(value, low, high):
    return f"{plain(value)} ({plain(low)} to {plain(high)})"


def size(count):
    return f"{count / 1e6:.1f} MB" if count >= 1e6 else f"{count / 1e3:.0f} kB"


def percent(share):
    """8.1 or 22."""
    value = 100 * share
    return f"{value + 1e-9:.0f}" if round(value, 1) >= 10 else f"{value:.1f}"


def exact_text(share):
    """100 % or 57.5 %."""
    return f"{100 * share:.1f}".removesuffix(".0") + " %"


def digits(value):
    """Three digits, and thousands set apart: 0.18, 9.57, 28.1, 1,280."""
    return f"{value:,.0f}" if value >= 100 else f"{value:#.3g}".rstrip(".")


def span(values):
    return (min(values), max(values))


def power(value):
    """Two digits and a power of ten: 4.4e-5."""
    digits_of, exponent = f"{value:.1e}".split("e")
    return f"{digits_of}e{int(exponent)}"


def numbers_of(text):
    return [float(number) if "." in number else int(number) for number in re.findall(r"\d+(?:\.\d+)?", text)]
