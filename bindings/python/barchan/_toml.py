"""Decks from dicts: TOML as far as decks need it."""
import json
import math
import numbers


def value_text(value) -> str:
    """A value as TOML writes it."""
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        if math.isinf(value):
            return "inf" if value > 0 else "-inf"
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(value_text, value)) + "]"
    raise TypeError(f"a deck cannot hold {value!r}: numbers, words, booleans, lists and dicts are possible")


def _key(key) -> str:
    if not isinstance(key, str):
        raise TypeError(f"a key of a deck is a word, not {key!r}")
    return key if key.replace("_", "a").replace("-", "a").isalnum() and key.isascii() else json.dumps(key)


def deck_text(deck: dict) -> str:
    """A deck as TOML: tables for dicts, arrays of tables for lists of dicts."""
    return "".join(f"{_key(key)} = {value_text(value)}\n" for key, value in deck.items())
