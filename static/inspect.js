// Looks into the scene: turns mouse and keys into the next frame to ask for, one at a time.

const start = JSON.parse(document.body.dataset.start);
const FIXED = "fixed"; // an eye that keeps its levels
const LETTERS = start.levels.map((level) => level[0]);
const VIEWS = ["both", "halves", "left", "right"];
const VIEW_NAMES = { both: "both eyes", halves: "each in its half", left: "left eye", right: "right eye" };
const TARGETS = { "both eyes": ["left", "right"], "the left eye": ["left"], "the right eye": ["right"] };
const COARSE = 2; // while something moves, pictures are so many times smaller
const REST_MS = 300; // after the last move, before the fine picture is asked for
const DEG_PER_PX = 0.25;
const IRIS_MM = 11.7;
const ALONE_MM = 40; // from an eye's centre to the other one's corner, and a little less
const PLAN_PX = 320; // about as wide as the scene from above is shown
const find = (id) => document.getElementById(id);

const canvas = find("picture");
const first = () => ({ ...start.first });

let look = first();
let target = "both eyes";
let fine = false; // full size even while moving
let busy = false;
let wanted = null; // how much smaller the next picture is to be, or null
let rest = 0;
let playing = null; // when time began to run, and from where
const frames = []; // when the last pictures came
let plan = null; // the scene from above: its picture, and how far around the face it reaches
let planning = false;

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

function address(path, divide) {
  return `${path}?${new URLSearchParams({ ...look, divide: String(divide) })}`;
}

async function picture(path, divide) {
  const answer = await fetch(address(path, divide)).catch(() => {
    throw new Error("the command does not answer; start ocularist inspect again");
  });
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
      look.time = Math.round((performance.now() - playing) % 3_600_000) / 1000;
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
  const page = frames.length > 1 ? ((frames.length - 1) * 1000) / (now - frames[0]) : 0;
  find("where").textContent =
    `Azimuth ${look.azimuth.toFixed(0)}°, elevation ${look.elevation.toFixed(0)}°, time ${look.time.toFixed(1)} s. ` +
    `Picture ${bitmap.width} × ${bitmap.height}` +
    (page ? `, ${page.toFixed(1)}/s reach this page.` : ".");
  for (const [eye, side] of ["left", "right"].entries()) {
    find(`lod-${side}`).textContent = facts.lods[eye];
    find(`iris-${side}`).textContent = facts.iris_px[eye].toFixed(1);
    find(`seen-${side}`).textContent = facts.visible_px[eye].toLocaleString("en");
  }
  if (plan?.reach === facts.marks.reach_mm) mark(facts.marks);
  else void above();
}

async function above() {
  if (planning) return;
  planning = true;
  const fault = find("above-fault");
  try {
    const [bitmap, facts] = await picture("/overhead", clamp(Math.floor(start.size[0] / PLAN_PX), 1, 8));
    plan = { bitmap, reach: facts.marks.reach_mm };
    mark(facts.marks);
    find("above").dataset.drawn = String(Number(find("above").dataset.drawn ?? 0) + 1);
    fault.textContent = "";
  } catch (error) {
    fault.textContent = `No picture: ${error.message}`;
  }
  planning = false;
}

// Draw the scene from above with the camera's place, which moves while the picture stays.
function mark(marks) {
  const canvas = find("above");
  const ink = canvas.getContext("2d");
  [canvas.width, canvas.height] = [plan.bitmap.width, plan.bitmap.height];
  ink.drawImage(plan.bitmap, 0, 0);
  if (!marks.camera || !marks.eyes) return;
  const at = (place) => [place[0] * canvas.width, place[1] * canvas.height];
  canvas.dataset.camera = marks.camera.map((share) => share.toFixed(3)).join(" ");
  ink.strokeStyle = "#ffd24d";
  ink.lineWidth = 1.5;
  ink.beginPath();
  ink.moveTo(...at(marks.camera));
  ink.lineTo(...at(marks.eyes));
  ink.stroke();
  ink.beginPath();
  ink.arc(...at(marks.camera), 4, 0, 7);
  ink.stroke();
}

function showLevels() {
  for (const select of document.querySelectorAll("select")) {
    const switching = look[`${select.dataset.side}_switching`];
    const isSwitch = "switching" in select.dataset;
    select.value = isSwitch ? switching : look[select.dataset.side][Number(select.dataset.number)];
    select.classList.toggle("unused", !isSwitch && switching !== FIXED);
  }
  find("target").textContent = target;
  find("eyes").querySelector("span").textContent = VIEW_NAMES[look.eyes];
  find("wireframe").ariaPressed = String(look.wireframe);
  find("play").ariaPressed = String(playing !== null);
  find("fine").ariaPressed = String(fine);
}

function setLevel(side, number, letter) {
  look[`${side}_switching`] = FIXED;
  look[side] = look[side].slice(0, number) + letter + look[side].slice(number + 1);
}

function step(number, by) {
  for (const side of TARGETS[target]) {
    const at = LETTERS.indexOf(look[side][number]);
    setLevel(side, number, LETTERS[(at + by + LETTERS.length) % LETTERS.length]);
  }
}

function setAll(letter) {
  for (const side of TARGETS[target]) {
    look[`${side}_switching`] = FIXED;
    look[side] = letter.repeat(look[side].length);
  }
}

function nextSwitching() {
  const now = next(start.switchings, look[`${TARGETS[target][0]}_switching`]);
  for (const side of TARGETS[target]) look[`${side}_switching`] = now;
}

const turn = (azimuth, elevation) => {
  look.azimuth = ((look.azimuth + azimuth + 540) % 360) - 180;
  look.elevation = clamp(look.elevation + elevation, -start.steepest, start.steepest);
};
const nearer = (factor) => goTo(clamp(look.distance * factor, 4, start.largest));
const next = (list, now) => list[(list.indexOf(now) + 1) % list.length];

// An eye is alone in its half, or in the picture, while nothing of the other one comes into view.
function isAlone(eyes, distance) {
  const half = (start.size[0] / start.size[1]) * 540 * (eyes === "halves" ? 0.5 : 1);
  return (half * IRIS_MM) / distance < ALONE_MM;
}

function goTo(distance) {
  look.distance = distance;
  if (look.eyes !== "both" && !isAlone(look.eyes, distance)) look.eyes = "both";
}

// The next farther one of the four; after the last the nearest.
function nextDistance() {
  goTo(start.distances.find((size) => size < look.distance - 0.5) ?? start.distances[0]);
}

function nextView() {
  look.eyes = next(VIEWS, look.eyes);
  if (look.eyes !== "both" && !isAlone(look.eyes, look.distance)) look.distance = start.distances[0];
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
  b: nextSwitching,
  d: nextDistance,
  e: () => (target = next(Object.keys(TARGETS), target)),
  v: nextView,
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

// What a control needs itself while it has the focus. Everything else stays a key of the page, so
// that a click on a button or a choice in a list ends no key's use.
const OWN_KEYS = {
  BUTTON: [" ", "Enter"],
  SUMMARY: [" ", "Enter"],
  SELECT: [" ", "Enter", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", ...LETTERS],
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const own = OWN_KEYS[event.target.tagName] ?? [];
  if (own.includes(event.key) || own.includes(event.key.toLowerCase())) return;
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
canvas.addEventListener("lostpointercapture", () => canvas.classList.remove("dragged"));
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
    const side = select.dataset.side;
    if ("switching" in select.dataset) look[`${side}_switching`] = select.value;
    else setLevel(side, Number(select.dataset.number), select.value);
    showLevels();
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
