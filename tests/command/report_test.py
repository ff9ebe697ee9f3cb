"""report writes one page that needs nothing else; where there is a Chromium, the page is opened, clicked and looked at."""
import json
import os
import re
import shutil
import subprocess

from _helper import DECK, expect, finish, fresh, messages, run, write

BROWSER = next(filter(None, map(shutil.which, ("chromium-headless-shell", "chromium", "google-chrome"))), None)
SOFTWARE = ("--no-sandbox", "--headless", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1240,900",
            "--virtual-time-budget=3000")
# Acts as a reader would, and leaves what it saw in the title.
LOOK = """
const scene = document.getElementById('scene'), seen = {errors};
function pixels() {
  const copy = document.createElement('canvas');
  copy.width = scene.width; copy.height = scene.height;
  const pen = copy.getContext('2d');
  pen.drawImage(scene, 0, 0);
  const bytes = pen.getImageData(0, 0, copy.width, copy.height).data, colours = new Map();
  for (let i = 0; i < bytes.length; i += 4) { const c = bytes.slice(i, i + 3).join(); colours.set(c, (colours.get(c) || 0) + 1); }
  return colours;
}
const covered = of => [...of.values()].reduce((s, n) => s + n, 0) - Math.max(...of.values());
const change = (id, value, kind) => { const e = document.getElementById(id); e.value = value; e.dispatchEvent(new Event(kind)); };
if (scene) {
  seen.drawer = scene.dataset.drawer;
  seen.last = covered(pixels());
  change('field', 'rank', 'change');
  const ranks = pixels();
  seen.blue = ranks.get('0,114,178') || 0;
  seen.orange = ranks.get('213,94,0') || 0;
  change('frame', 0, 'input');
  seen.label = scene.getAttribute('aria-label');
  scene.dispatchEvent(new KeyboardEvent('keydown', {key: '+'}));
  seen.nearer = covered(pixels());
}
const svg = document.querySelector('svg.plot'), ticksOf = () => [...svg.querySelectorAll('text')].map(t => t.textContent).join();
if (svg) {
  const before = ticksOf();
  svg.dispatchEvent(new KeyboardEvent('keydown', {key: '+'}));
  seen.zoomed = ticksOf() !== before;
  svg.dispatchEvent(new KeyboardEvent('keydown', {key: '0'}));
  seen.back = ticksOf() === before;
}
const mark = document.querySelector('svg.plot circle[role=link]');
if (mark) { mark.dispatchEvent(new MouseEvent('click')); seen.chosen = document.querySelector('tr.chosen')?.textContent; }
seen.ready = document.body.dataset.ready;
seen.text = document.querySelector('main').textContent;
seen.unnamed = [...document.querySelectorAll('canvas, svg.plot, input[type=range], select')].filter(e => !e.getAttribute('aria-label')).length;
document.title = JSON.stringify(seen);
"""


def data_of(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    expect(not re.search(r"(src|href)\s*=\s*[\"']https?:", text) and "url(" not in text, f"{path} loads something")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    return json.loads(found.group(1))


def looked_at(path):
    """What a browser saw of a page, or nothing without a browser."""
    if not BROWSER:
        return None
    with open(path, encoding="utf-8") as file:
        page = file.read()
    caught = "<script>const caught = []; addEventListener('error', e => caught.push(e.message));</script>"
    page = page.replace("<title>", caught + "<title>", 1)
    page = page.replace("</body>", "<script>" + LOOK.replace("{errors}", "{errors: caught}") + "</script></body>")
    write("look.html", page)
    done = subprocess.run([BROWSER, *SOFTWARE, "--dump-dom", "file://" + os.path.abspath("look.html")], capture_output=True,
                          text=True, timeout=120)
    found = re.search(r"<title>(.*?)</title>", done.stdout, re.DOTALL)
    if not found:
        print("the browser does not work here: " + done.stderr[-300:])
        return None
    seen = json.loads(found.group(1).replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))
    expect(seen["ready"] == "yes" and not seen["errors"] and seen["unnamed"] == 0, f"{path}: {seen}")
    return seen


def check_run():
    fresh("r.out")
    done = run("run", "case.toml", "--out", "r.out", "--trace", "--quiet", "--exchange", "isend", "--set",
               "output.snapshots_every=50", ranks=2)
    expect(done.returncode == 0, f"run: {done}")
    done = run("report", "r.out", "--steps", "100:110")
    expect(done.returncode == 0 and done.stdout.startswith("r.out/report.html: "), f"report: {done}")
    data = data_of("r.out/report.html")
    with open("r.out/run.json", encoding="utf-8") as file:
        numbers = json.load(file)
    expect(data["run"]["state_digest"] == numbers["state_digest"] and data["deck"]["wall.1.name"] == '"floor"', "run.json")
    expect([f["step"] for f in data["view"]["frames"]] == [0, 50, 100, 150, 200], "frames")
    expect(all(f["n"] == 350 for f in data["view"]["frames"]) and data["view"]["materials"] == ["sand"], "particles")
    expect(data["trace"]["steps"] == [100, 110] and data["trace"]["workers"] == [1, 1], f"trace: {data['trace']['steps']}")
    expect(len(data["trace"]["messages"]) >= 20 and all(m[2] <= m[5] and m[0] != m[3] for m in data["trace"]["messages"]),
           "messages")
    expect(data["series"]["columns"][:2] == ["step", "time"] and data["series"]["rows"][-1][0] == 200, "series")
    if seen := looked_at("r.out/report.html"):
        expect(seen["last"] > 20000 and min(seen["blue"], seen["orange"]) > 2000, f"pixels: {seen}")
        expect(seen["label"] == "350 particles at step 0, coloured by rank" and seen["nearer"] > 1000, f"film: {seen}")
        hidden = 100 * numbers["communication"]["hidden_fraction"]
        share = f"{hidden:.1f} %" if 0 < hidden < 9.95 else f"{hidden:.0f} %"
        expect(seen["zoomed"] and seen["back"] and share + " of the communication was hidden" in seen["text"], f"plots: {seen}")
    done = run("report", "r.out", "--frames", "2", "--out", "two.html")
    expect([f["step"] for f in data_of("two.html")["view"]["frames"]] == [0, 200], f"two frames: {done}")
    os.remove("r.out/run.json")
    done = run("report", "r.out")
    expect(done.returncode == 0 and "run" not in data_of("r.out/report.html"), f"a run that has not ended: {done}")


def check_deck():
    fresh("case.html")
    done = run("report", "case.toml", "--set", "gravity=[0.0, -1.62]", "--set", "title=</script><b>")
    expect(done.returncode == 0, f"report of a deck: {done}")
    data = data_of("case.html")
    expect(data["view"]["frames"][0]["n"] == 350 and "Stable step" in data["check"], f"deck: {data['check']}")
    expect(data["deck"]["gravity"] == "[0, -1.62]" and data["about"] == "</script><b>", f"deck: {data['deck']}")


def check_sweep():
    fresh("s")
    run("sweep", "case.toml", "--out", "s", "--exchange", "isend", "--ranks", "1,2", "--repeat", "1", "--steps", "20", "--quiet")
    done = run("report", "s")
    expect(done.returncode == 0, f"report of a sweep: {done}")
    data = data_of("s/report.html")
    links = [run["link"] for point in data["sweep"]["points"] for run in point["runs"]]
    expect(len(links) == 2 and all(os.path.exists("s/" + link) for link in links), f"links: {links}")
    expect(data["sweep"]["axes"] == ["ranks"] and data["sweep"]["base"] == "ranks=1", f"sweep: {data['sweep']}")
    if seen := looked_at("s/report.html"):
        expect(seen["chosen"] and "speed-up" in seen["text"], f"sweep: {seen}")


def check_wrong_input():
    write("mine.html", "<p>mine</p>")
    write("bad.toml", DECK.replace("friction", "frction"))
    for words, remedy in [(("nowhere",), "give the folder"), (("bad.toml",), "did you mean"), (("case.toml", "--out", "mine.html"), "--out"),
                          (("s", "--set", "a=1"), "deck"), (("s/runs",), "has no run"), (("r.out", "--steps", "5"), "range"),
                          (("r.out", "--steps", "900:910"), "nothing of steps"), (("case.csv",), "no such file")]:
        done = run("report", *words)
        expect(done.returncode == 2 and len(messages(done)) == 1 and remedy in done.stderr, f"report {words}: {done}")
    with open("mine.html", encoding="utf-8") as file:
        expect(file.read() == "<p>mine</p>", "a file of somebody else was replaced")


write("case.toml", DECK)
check_run()
check_deck()
check_sweep()
check_wrong_input()
finish()
