"""What the docs name exists: files, links, deck keys, options, names in the code; and files that comments name.

Deck keys are those of the tables in docs/deck.md, which a unit test holds against the reader of decks.
"""
import os
import pathlib
import re
import sys

TREE = pathlib.Path(os.environ.get("BARCHAN_SOURCE", pathlib.Path(__file__).resolve().parents[1]))
LAYERS = ("core", "comm", "tasks", "app")
FOLDERS = LAYERS + ("bench", "bindings", "cmake", "docs", "examples", "tests")
NAMED_FILE = re.compile(r"(?<![\w/.<*-])((?:[\w.-]+/)*[\w-]+\.(?:hpp|cpp|md|py|sh|cmake|supp))\b")
OF_OTHERS = {"--mca", "--bind-to", "--cpu-bind", "--mpi", "--oversubscribe", "--launcher", "--version", "--help",
             "--gtest_filter", "--gtest_repeat", "--preset", "--build", "--install", "--prefix", "--allow-run-as-root"}
WORDS_OF_OTHERS = {"tc", "odls_base_sigkill_timeout", "mpi_yield_when_idle", "MPI_ERR_WIN", "ring1_diameter_x", "ring1_diameter_y"}
IDIOMS = re.compile(r"\b(is told|are told|to be had|so many|goes on without|the like of|as it stands)\b")
faults = []


def files(*folders, suffixes):
    for folder in folders:
        for path in sorted((TREE / folder).rglob("*")):
            if path.is_file() and path.suffix in suffixes and "build" not in path.relative_to(TREE).parts:
                yield path


def text_of(path):
    return path.read_text(encoding="utf-8", errors="replace")


DOCS = [TREE / "README.md", *files("docs", suffixes={".md"}), *(TREE / "bench").glob("*.md"),
        *(TREE / "bench" / "netlab").glob("*.md")]
ALL_FILES = [p.relative_to(TREE).as_posix() for p in files(*FOLDERS, suffixes={
    ".hpp", ".cpp", ".md", ".py", ".sh", ".cmake", ".supp", ".h", ".c", ".f90"})] + ["README.md", "CHANGELOG.md"]
SCRIPTS = [p for p in files("bench", "examples", "tests", suffixes={"", ".py", ".sh"}) if p.name != "docs_test.py"]
SCRIPTS.append(TREE / "quickstart")
CODE = [*files(*FOLDERS, suffixes={".hpp", ".cpp", ".h", ".c", ".f90", ".cmake", ".txt", ".supp"}), *SCRIPTS, *TREE.glob("CMake*")]
CODE_TEXT = "\n".join(map(text_of, CODE))
WORDS = set(re.findall(r"\w+", CODE_TEXT))
OPTIONS = set(re.findall(r"(?<![\w-])--[a-z][\w-]*", "\n".join(map(text_of, [*files("app", suffixes={".cpp"}), *SCRIPTS]))))


def deck_tables():
    """{table: its keys}"""
    tables, table = {}, None
    for line in text_of(TREE / "docs/deck.md").splitlines():
        if found := re.match(r"<!-- keys of (.*) -->", line):
            table = tables.setdefault(found.group(1).strip("[]"), set())
        elif not line:
            table = None
        elif table is not None and (found := re.match(r"\| `(\w+)` \|", line)):
            table.add(found.group(1))
    return tables


TABLES = deck_tables()
KEYS = set().union(*TABLES.values())


def exists(name, beside):
    """A path from the root, beside the page, or the end of some path."""
    return ((TREE / name).exists() or (beside / name).exists() or
            any(path.endswith("/" + name) for path in ALL_FILES) or name in ALL_FILES)


def check_files(place, text, beside):
    for name in NAMED_FILE.findall(text):
        name = name.removeprefix("barchan/").removeprefix("./")
        if not exists(name, beside):
            faults.append(f"{place}: no file {name}")


def check_links(page, text):
    for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
        if "://" not in target and not (page.parent / target).exists():
            faults.append(f"{page.name}: the link to {target} leads nowhere")


def check_code_names(place, quoted):
    """`Name`, `name`, `A::b`: every part is a word of the code."""
    if quoted not in WORDS_OF_OTHERS and re.fullmatch(r"[A-Za-z]\w*(::~?\w+)*(\(\))?", quoted):
        for word in re.findall(r"\w+", quoted):
            if word not in WORDS and re.sub(r"_[xyz]$", "", word) not in WORDS:
                faults.append(f"{place}: `{quoted}` is no name in the code")


def check_deck_keys(place, quoted):
    """`table.key`, `table.name.key`, perhaps with ` = value`."""
    found = re.match(r"([a-z]+)(?:\.[\w-]+)?\.(\w+)(?:\s*=.*)?$", quoted)
    if found and found.group(1) in TABLES and found.group(2) not in TABLES[found.group(1)] | {"md", "toml"}:
        faults.append(f"{place}: [{found.group(1)}] has no key {found.group(2)}")


def check_options(place, text):
    text = "\n".join(line for line in text.splitlines() if not re.match(r"#SBATCH|.*\[--w--\]", line))
    for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", text):
        if option not in OPTIONS | OF_OTHERS:
            faults.append(f"{place}: no command takes {option}")


def check_paths(place, quoted):
    """The first word, where it begins with a folder of the tree; braces and stars stand for what they match."""
    name = quoted.split(" ")[0].removeprefix("./")
    if name.split("/")[0] in FOLDERS and "/" in name and not re.search(r"[{}<>A-Z…]", name):
        if not any(TREE.glob(name.rstrip("/"))):
            faults.append(f"{place}: no {name}")


def check_toml(place, block):
    for line in block.splitlines():
        key = re.match(r"(\w+)\s*=", line)
        for name in ([key.group(1)] if key else []) + re.findall(r"[{,]\s*(\w+)\s*=", line.split("#")[0]):
            if name not in KEYS:
                faults.append(f"{place}: the deck has no key {name}")


def check_page(page):
    place, text = page.relative_to(TREE).as_posix(), text_of(page)
    check_links(page, text)
    check_english(place, text)
    check_options(place, text)
    for block in re.findall(r"^```toml\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        check_toml(place, block)
    prose = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    check_files(place, re.sub(r"\]\([^)]*\)", "", prose), page.parent)
    for quoted in re.findall(r"`([^`\n]+)`", prose):
        check_code_names(place, quoted)
        check_deck_keys(place, quoted)
        check_paths(place, quoted)
        if page.name in ("theory.md", "limits.md") and re.fullmatch(r"\w*_\w*", quoted) and quoted not in KEYS:
            faults.append(f"{place}: the deck has no key {quoted}")


def check_english(place, text):
    """Phrases that a reader with school English stumbles over, in pages and messages."""
    for phrase in IDIOMS.findall(text):
        faults.append(f"{place}: say '{phrase}' in plainer words")


def check_comments(path):
    check_english(path.relative_to(TREE).as_posix(), "\n".join(re.findall(r'"(?:[^"\\\n]|\\.)*"', text_of(path))))
    comments = "\n".join(re.findall(r"//.*", text_of(path)))
    check_files(path.relative_to(TREE).as_posix(), comments, path.parent)


for each in DOCS:
    check_page(each)
for each in files(*LAYERS, suffixes={".hpp", ".cpp"}):
    check_comments(each)
print("\n".join(faults))
sys.exit(1 if faults else 0)
