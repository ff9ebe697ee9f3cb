"""Completion, manual pages and the schema of the deck follow from what the command is."""
import glob
import os
import shutil
import subprocess
import tomllib

import json

from _helper import DECK, COMMAND, expect, finish, messages, run, write

EXAMPLES = os.path.join(os.environ.get("BARCHAN_SOURCE", os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")), "examples")
COMMANDS = [line.split()[0] for line in run("--help").stdout.split("Subcommands:")[1].split("\n\n")[0].splitlines()
            if line.startswith("  ") and line[2] != " "]


def check_completion():
    for shell in ("bash", "zsh", "fish"):
        text = run("completion", shell).stdout
        for command in COMMANDS:
            expect(command in text, f"{shell} does not complete {command}")
        expect("put-inband" in text and "schedule" in text and "all-pairs" in text, f"{shell}: values")
    write("barchan.bash", run("completion", "bash").stdout)
    for words, wanted in [(["re"], ["report"]), (["run", "--sched"], ["--schedule"]), (["run", "--schedule", "seq"], ["sequential"]),
                          (["sweep", "--exchange", "put"], ["put-flag", "put-inband"]), (["check", "barchan.b"], ["barchan.bash"])]:
        script = (f"source ./barchan.bash; COMP_WORDS=(barchan {' '.join(words)}); COMP_CWORD={len(words)}; _barchan; "
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True)
        expect(sorted(done.stdout.split()) == wanted and not done.stderr, f"{words}: {done}")
    done = run("completion", "bish")
    expect(done.returncode == 2 and "bash" in done.stderr, f"completion of an unknown shell: {done}")


def check_man():
    os.makedirs("man", exist_ok=True)
    done = run("man", "--out", "man")
    expect(done.returncode == 0 and len(os.listdir("man")) == len(COMMANDS) + 1, f"man: {done} {os.listdir('man')}")
    for command in COMMANDS:
        page = run("man", command).stdout
        for line in run(command, "--help").stdout.splitlines():
            option = line.strip().split(" ")[0].split(",")[-1]
            expect(not option.startswith("--") or option.replace("-", "\\-") in page, f"man {command}: no {option}")
    if shutil.which("groff"):
        for page in sorted(glob.glob("man/*.1")):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", page], capture_output=True, text=True)
            expect(done.returncode == 0 and not done.stderr, f"{page}: {done.stderr}")
    done = run("man", "rn")
    expect(done.returncode == 2 and len(messages(done)) == 1 and "run" in done.stderr, f"man of no command: {done}")
    done = run("man", "--out", "nowhere")
    expect(done.returncode == 1 and len(messages(done)) == 1, f"man into no folder: {done}")


def fault(value, schema, root, path="deck"):
    """Why a value does not agree with a schema; only the words that deck_schema writes."""
    if "$ref" in schema:
        schema = root["$defs"][schema["$ref"].rsplit("/", 1)[1]]
    for word, few in (("anyOf", 1), ("oneOf", 1)):
        if word in schema:
            faults = [fault(value, one, root, path) for one in schema[word]]
            return "" if faults.count("") >= few else f"{path}: none of {faults}"
    kinds = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}
    if "type" in schema and (not isinstance(value, kinds[schema["type"]]) or isinstance(value, bool) != (schema["type"] == "boolean")):
        return f"{path} is no {schema['type']}"
    if "enum" in schema and value not in schema["enum"]:
        return f"{path}: {value} is not in {schema['enum']}"
    if isinstance(value, dict):
        for key in schema.get("required", []):
            if key not in value:
                return f"{path}: no {key}"
        for key, inner in value.items():
            if key not in schema["properties"]:
                return f"{path}: unknown {key}"
            if found := fault(inner, schema["properties"][key], root, f"{path}.{key}"):
                return found
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", 1e9):
            return f"{path}: {len(value)} items"
        return next(filter(None, (fault(item, schema.get("items", {}), root, path) for item in value)), "")
    if isinstance(value, (int, float)) and not (schema.get("minimum", value) <= value <= schema.get("maximum", value)
                                                and schema.get("exclusiveMinimum", value - 1) < value):
        return f"{path}: {value} is out of range"
    return ""


def check_schema():
    schema = json.loads(run("schema").stdout)
    decks = sorted(glob.glob(EXAMPLES + "/*.toml"))
    expect(len(decks) > 5, "no examples")
    for path in decks:
        with open(path, "rb") as file:
            why = fault(tomllib.load(file), schema, schema)
        expect(not why, f"{path}: {why}")
    for old, new in [("friction", "frction"), ("1e-4", "-1e-4"), ('"lattice"', '"latice"'), ('kind = "lattice"', 'kind = "ring"'),
                     ("lo = [0.0, 0.0]\n", ""), ("dimension = 2", "dimension = 2.5")]:
        wrong = tomllib.loads(DECK.replace(old, new, 1))
        expect(fault(wrong, schema, schema), f"the schema takes {new}")
    words = json.dumps(schema)
    expect("restitution" in words and "[m]" in words, "meanings and units")


check_completion()
check_man()
check_schema()
finish()
