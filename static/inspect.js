// Looks into the scene: turns mouse and keys into the next frame to ask for, one at a time.

const start = JSON.parse(document.body.dataset.start);
const LETTERS = start.levels.map((level) => level[0]);
const VIEWS = ["both", "halves", "left", "right"];
const VIEW_NAMES = { both: "both eyes", halves: "each in its half", left: "left eye", right: "right eye" };
const TARGETS = { "both eyes": ["left", "right"], "the left eye": ["left"], "the right eye": ["right"] };
const COARSE = 2; // while something moves, pictures are so many times smaller
const REST_MS = 300; // after the last move, before the fine picture is asked for
const DEG_PER_PX = 0.25;
const find = (id) => document.getElementById(id);

const canvas = find("picture");
const first = () => ({
  left: start.left,
  right: start.right,
  azimuth: 0,
  elevation: 0,
  distance: start.distance,
  time: 0,
  eyes: start.eyes,
  wireframe: false,
});

let look = first();
let target = "both eyes";
let fine = false; // full size even while moving
let busy = false;
let wanted = null; // how much smaller the next picture is to be, or null
let rest = 0;
let playing = null; // when time began to run, and from where
const frames = []; // when the last pictures came

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

function address(path, divide) {
  return `${path}?${new URLSearchParams({ ...look, divide: String(divide) })}`;
}

async function picture(path, divide) {
  const answer = await fetch(address(path, divide));
  if (!answer.ok) throw new Error(`${answer.status}: ${(await answer.text()).slice(0, 300)}`);
  const facts = JSON.parse(answer.headers.get("X-Inspect"));
  return [await createImageBitmap(await answer.blob()), facts];
}

// Ask for a frame: at once if none is on its way, else after it. The finer wish never wins over a
// move, because the move asks for a fine one when it rests.
function want(divide) {
  wanted = divide;
  if (!busy) void run();
}

function moved() {
  want(fine ? 1 : COARSE);
  clearTimeout(rest);
  if (!fine) rest = setTimeout(() => playing === null && want(1), REST_MS);
}

async function run() {
  busy = true;
  while (wanted !== null) {
    const divide = wanted;
    wanted = null;
    try {
      const [bitmap, facts] = await picture("/frame", divide);
      show(bitmap, facts);
      find("waiting").hidden = true;
    } catch (error) {
      const note = find("waiting");
      note.textContent = `No picture: ${error.message}`;
      note.classList.add("fault");
      note.hidden = false;
      break;
    }
    if (playing !== null) {
      look.time = Math.round(((performance.now() - playing) % 3_600_000)) / 1000;
      wanted ??= fine ? 1 : COARSE;
    }
  }
  busy = false;
}

function show(bitmap, facts) {
  [canvas.width, canvas.height] = start.size;
  canvas.getContext("2d").drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  canvas.dataset.drawn = String(Number(canvas.dataset.drawn ?? 0) + 1);
  canvas.dataset.width = String(bitmap.width);
  const now = performance.now();
  frames.push(now);
  while (frames.length > 1 && now - frames[0] > 2000) frames.shift();
  find("rate").textContent = (1000 / facts.ms).toFixed(facts.ms < 100 ? 0 : 1);
  find("ms").textContent = facts.ms.toFixed(facts.ms < 10 ? 2 : 0);
  find("triangles").textContent = facts.triangles.toLocaleString("en");
  const [a, b] = facts.iris_px;
  const [c, d] = facts.visible_px;
  const page = frames.length > 1 ? ((frames.length - 1) * 1000) / (now - frames[0]) : 0;
  find("where").textContent =
    `Azimuth ${look.azimuth.toFixed(0)}°, elevation ${look.elevation.toFixed(0)}°, time ${look.time.toFixed(1)} s. ` +
    `Picture ${bitmap.width} × ${bitmap.height}: irises ${a} and ${b} px wide, ${c} and ${d} px of eye seen. ` +
    `Left ${facts.lods[0]}, right ${facts.lods[1]}. ` +
    (page ? `${page.toFixed(1)} pictures/s reach this page.` : "");
}

async function above() {
  const plan = find("above");
  try {
    const [bitmap, facts] = await picture("/overhead", 4);
    const ink = plan.getContext("2d");
    [plan.width, plan.height] = [bitmap.width, bitmap.height];
    ink.drawImage(bitmap, 0, 0);
    const at = (mark) => [mark[0] * plan.width, mark[1] * plan.height];
    ink.strokeStyle = "#ffd24d";
    ink.lineWidth = 1.5;
    if (facts.marks.camera && facts.marks.eyes) {
      ink.beginPath();
      ink.moveTo(...at(facts.marks.camera));
      ink.lineTo(...at(facts.marks.eyes));
      ink.stroke();
      ink.beginPath();
      ink.arc(...at(facts.marks.camera), 4, 0, 7);
      ink.stroke();
    }
    plan.dataset.drawn = "1";
  } catch (error) {
    plan.title = String(error);
  }
}

function showLevels() {
  for (const select of document.querySelectorAll("select")) {
    select.value = look[select.dataset.side][Number(select.dataset.number)];
  }
  find("target").textContent = target;
  find("eyes").querySelector("span").textContent = VIEW_NAMES[look.eyes];
  find("wireframe").ariaPressed = String(look.wireframe);
  find("play").ariaPressed = String(playing !== null);
  find("fine").ariaPressed = String(fine);
}

function setLevel(side, number, letter) {
  look[side] = look[side].slice(0, number) + letter + look[side].slice(number + 1);
}

function step(number, by) {
  for (const side of TARGETS[target]) {
    const at = LETTERS.indexOf(look[side][number]);
    setLevel(side, number, LETTERS[(at + by + LETTERS.length) % LETTERS.length]);
  }
}

const setAll = (letter) => TARGETS[target].forEach((side) => (look[side] = letter.repeat(look[side].length)));
const turn = (azimuth, elevation) => {
  look.azimuth = ((look.azimuth + azimuth + 540) % 360) - 180;
  look.elevation = clamp(look.elevation + elevation, -80, 80);
};
const nearer = (factor) => (look.distance = clamp(look.distance * factor, 4, start.largest));
const next = (list, now) => list[(list.indexOf(now) + 1) % list.length];

function nextDistance() {
  const sizes = Object.values(start.distances);
  look.distance = sizes.find((size) => size < look.distance - 0.5) ?? sizes[0];
}

function togglePlay() {
  playing = playing === null ? performance.now() - look.time * 1000 : null;
  if (playing === null) void above(); // where everybody has come to
}

const KEYS = {
  ArrowLeft: () => turn(-5, 0),
  ArrowRight: () => turn(5, 0),
  ArrowUp: () => turn(0, 5),
  ArrowDown: () => turn(0, -5),
  "+": () => nearer(1.15),
  "=": () => nearer(1.15),
  "-": () => nearer(1 / 1.15),
  d: nextDistance,
  e: () => (target = next(Object.keys(TARGETS), target)),
  v: () => (look.eyes = next(VIEWS, look.eyes)),
  w: () => (look.wireframe = !look.wireframe),
  f: () => (fine = !fine),
  r: () => {
    look = first();
    playing = null;
  },
  a: () => void above(),
  " ": togglePlay,
  ...Object.fromEntries(LETTERS.map((letter) => [letter, () => setAll(letter)])),
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches("select, button, summary")) return;
  const digit = /^Digit([1-7])$/.exec(event.code);
  if (digit) step(Number(digit[1]) - 1, event.shiftKey ? -1 : 1);
  else if (KEYS[event.key]) KEYS[event.key]();
  else if (KEYS[event.key.toLowerCase()]) KEYS[event.key.toLowerCase()]();
  else return;
  event.preventDefault();
  showLevels();
  moved();
});

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  canvas.classList.add("dragged");
});
canvas.addEventListener("pointermove", (event) => {
  if (!canvas.hasPointerCapture(event.pointerId)) return;
  turn(-event.movementX * DEG_PER_PX, event.movementY * DEG_PER_PX);
  moved();
});
canvas.addEventListener("pointerup", () => {
  canvas.classList.remove("dragged");
  void above();
});
canvas.addEventListener(
  "wheel",
  (event) => {
    event.preventDefault();
    nearer(Math.exp(-event.deltaY * 0.001));
    moved();
  },
  { passive: false },
);

for (const select of document.querySelectorAll("select")) {
  select.addEventListener("change", () => {
    setLevel(select.dataset.side, Number(select.dataset.number), select.value);
    moved();
  });
}
for (const button of document.querySelectorAll("button[data-all]")) {
  button.addEventListener("click", () => {
    setAll(button.dataset.all);
    showLevels();
    moved();
  });
}
for (const [id, key] of [["eyes", "v"], ["wireframe", "w"], ["play", " "], ["fine", "f"], ["reset", "r"]]) {
  find(id).addEventListener("click", () => {
    KEYS[key]();
    showLevels();
    moved();
  });
}

[canvas.width, canvas.height] = start.size;
showLevels();
want(COARSE);
rest = setTimeout(() => want(1), REST_MS);
void above();
