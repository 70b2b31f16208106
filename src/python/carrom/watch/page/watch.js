// SPDX-License-Identifier: BSD-3-Clause
// The page: asks the server how far the run is, shows frames, and plays them back and forth.
"use strict";

const element = (id) => document.getElementById(id);
const KEPT_BYTES = 200e6, AHEAD = 3;

const page = {
  run: null, steps: [], index: -1, state: {}, curves: {}, field: null,
  frames: new Map(), bytes: 0, asked: new Set(),
  direction: 0, due: 0, shown: null, view: null, isViewWhole: true, generation: 0,
};

function timeText(seconds) {
  const s = Math.round(seconds), two = (n) => String(n).padStart(2, "0");
  return `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
}

function forgetFrames() {
  page.frames.clear();
  page.asked.clear();
  page.bytes = 0;
  page.generation++;
}

// Frames -------------------------------------------------------------------------------------

const isWholeKept = () => page.isViewWhole || !page.shown || page.shown.about.total <= 150000;
const key = (step) => `${step} ${element("colour").value} ${isWholeKept() ? "" : page.view.join()}`;

function keep(name, frame) {
  page.frames.set(name, frame);
  page.bytes += frame.bytes;
  for (const [old, one] of page.frames) {
    if (page.bytes <= KEPT_BYTES || old === name) break;
    page.frames.delete(old);
    page.bytes -= one.bytes;
  }
}

async function load(index) {
  const step = page.steps[index], name = key(step), generation = page.generation;
  if (step === undefined || page.frames.has(name) || page.asked.has(name)) return;
  page.asked.add(name);
  try {
    const view = isWholeKept() ? "" : `&view=${page.view.join()}`;
    const follow = page.direction === 0 && element("follow").checked ? "&follow=1" : "";
    const colour = element("colour").value;
    const answer = await fetch(`frame?step=${step}&colour=${colour}${view}${follow}`);
    if (!answer.ok) throw new Error(await answer.text());
    const about = JSON.parse(answer.headers.get("X-Frame"));
    const frame = Discs.parse(about, new Float32Array(await answer.arrayBuffer()));
    if (generation === page.generation) keep(name, frame);
  } catch (error) {
    element("note").textContent = error.message;
  } finally {
    page.asked.delete(name);
  }
  if (generation === page.generation && page.steps[page.index] === step) show();
}

function show() {
  const step = page.steps[page.index];
  const frame = page.frames.get(key(step));
  if (!frame) return load(page.index);
  const about = frame.about;
  if (!page.view || page.isViewWhole) page.view = about.room;
  const top = about.colour === "psi6" ? 1 : about.top || 0;
  const drawn = Discs.draw(element("discs"), frame, page.view, top);
  page.shown = frame;
  const counted = about.kind === "density"
    ? `density of ${about.shown} discs` : `${drawn} of ${about.total} discs drawn`;
  element("shown").textContent = `step ${about.step}: ${counted}`;
  const departed = about.total - about.inside;
  element("note").textContent = about.note || (departed ? `${departed} have left the box` : "");
  element("low").textContent = about.colour === "species" ? `${about.species} species` : "0";
  element("high").textContent = about.colour === "species" ? "" : Curves.number(top);
  Discs.drawGradient(element("gradient"), about.colour === "species" ? about.species : 0);
  element("cover").hidden = about.kind !== "density";
  if (about.kind === "density") Discs.drawShades(element("shades"));
  const { total, kind, walls } = about;
  Object.assign(document.body.dataset, { step, drawn, total, kind, walls: walls.join() });
  drawCurves();
}

function goTo(index) {
  page.index = Math.min(Math.max(index, 0), page.steps.length - 1);
  element("slider").value = page.index;
  if (page.index >= 0) show();
}

// Playing ------------------------------------------------------------------------------------

function play(direction) {
  page.direction = direction;
  if (direction !== 0) element("follow").checked = false;
  element("forth").classList.toggle("on", direction > 0);
  element("back").classList.toggle("on", direction < 0);
  if (direction > 0 && page.index === page.steps.length - 1) goTo(0);
  if (direction < 0 && page.index === 0) goTo(page.steps.length - 1);
  page.due = performance.now();
}

// A frame on or back.
function turn(by) {
  play(0);
  element("follow").checked = false;
  goTo(page.index + by);
}

function tick(now) {
  requestAnimationFrame(tick);
  if (page.direction === 0 || now < page.due || page.index < 0) return;
  const next = page.index + page.direction;
  if (next < 0 || next >= page.steps.length) return play(0);
  for (let k = 0; k < AHEAD; k++) load(next + k * page.direction);
  if (!page.frames.has(key(page.steps[next]))) return;
  page.due = Math.max(page.due + 1000 / element("speed").value, now - 100);
  goTo(next);
}

// The run ------------------------------------------------------------------------------------

function showState(state) {
  page.state = state;
  document.title = `${state.name} - Carrom`;
  element("name").textContent = state.name;
  element("status").textContent = element("status").className = state.status;
  element("message").textContent = state.message || "";
  const text = [];
  if (state.step !== undefined) {
    text.push(state.wanted ? `step ${state.step} of ${state.wanted}` : `step ${state.step}`);
    if (state.steps_per_second) text.push(`${Curves.number(state.steps_per_second)} steps/s`);
    if (state.seconds_left > 0) text.push(`${timeText(state.seconds_left)} left`);
  }
  element("progress").textContent = text.join(", ");
  element("bar").hidden = !state.wanted;
  element("bar").value = state.wanted ? state.step / state.wanted : 0;
  document.body.dataset.status = state.status;
  document.body.dataset.frames = page.steps.length;
}

function takeSteps(state) {
  if (state.run !== page.run) {
    forgetFrames();
    Object.assign(page, { run: state.run, steps: [], index: -1, curves: {} });
    Object.assign(page, { isViewWhole: true, view: null });
  }
  const before = page.steps[page.index];
  if (state.first < page.steps.length) forgetFrames(); // cut back by a restart
  page.steps = page.steps.slice(0, state.first).concat(state.steps);
  element("slider").max = Math.max(0, page.steps.length - 1);
  if (element("follow").checked && page.steps.length) goTo(page.steps.length - 1);
  else if (page.steps.length && page.steps[page.index] !== before) {
    const found = page.steps.indexOf(before);
    goTo(found < 0 ? page.steps.length - 1 : found);
  }
}

async function ask() {
  let pause = 2;
  try {
    const have = page.steps.length, last = have ? page.steps[have - 1] : -1;
    const answer = await fetch(`state?have=${have}&last=${last}`);
    if (!answer.ok) throw new Error(await answer.text());
    const state = await answer.json();
    pause = state.pause;
    takeSteps(state);
    showState(state);
    grantWishes();
    if (state.status !== "waiting") {
      const curves = await fetch("curves");
      if (curves.ok) page.curves = await curves.json();
      await loadField();
      drawCurves();
    }
  } catch (error) {
    element("status").textContent = element("status").className = "lost";
    element("message").textContent = error instanceof TypeError
      ? "The server has ended. Start it again: python3 -m carrom.watch FOLDER" : error.message;
  }
  setTimeout(ask, 1000 * pause);
}

// A run without profiles answers 404, and the figure stays hidden.
async function loadField() {
  const list = element("column"), name = list.value || "density";
  const answer = await fetch(`field?name=${name}`);
  page.field = answer.ok ? await answer.json() : null;
  element("profiles").hidden = page.field === null;
  if (page.field === null || list.length === page.field.names.length) return;
  list.replaceChildren(...page.field.names.map((one) => new Option(one, one, false, one === name)));
}

// Curves are as long as what has happened, so that the first steps of a long run show, too.
function drawCurves() {
  const last = Math.max(page.state.step || 1, page.steps[page.index] || 0);
  for (const name of ["energy", "pressure", "rate"]) {
    const curve = page.curves[name];
    if (curve) element(`${name}-title`).textContent = curve.title;
    Curves.draw(element(name), curve, last, page.steps[page.index] || 0);
  }
  if (page.field) Fields.draw(element("field"), page.field);
}

// Zoom ---------------------------------------------------------------------------------------

let viewTimer = 0;

// As wide and high as the picture, so that discs fill it.
function widened([x0, y0, x1, y1]) {
  const canvas = element("discs"), aspect = canvas.width / canvas.height;
  const width = Math.max(x1 - x0, (y1 - y0) * aspect), height = width / aspect;
  const x = (x0 + x1) / 2, y = (y0 + y1) / 2;
  return [x - width / 2, y - height / 2, x + width / 2, y + height / 2];
}

function setView(wished) {
  const room = page.shown.about.room, view = wished && widened(wished);
  const isWide = (axis) => view[axis + 2] - view[axis] >= room[axis + 2] - room[axis];
  page.isViewWhole = view === null || isWide(0) && isWide(1);
  page.view = page.isViewWhole ? room : view;
  if (page.shown.about.total <= 150000) return show();
  clearTimeout(viewTimer);
  viewTimer = setTimeout(show, 200);
}

function zoomAt(event) {
  if (!page.shown) return;
  event.preventDefault();
  const canvas = element("discs"), ratio = window.devicePixelRatio || 1;
  const map = Discs.mapping(canvas, page.view), box = canvas.getBoundingClientRect();
  const x = map.toX((event.clientX - box.left) * ratio);
  const y = map.toY((event.clientY - box.top) * ratio);
  const factor = event.deltaY > 0 ? 1.25 : 0.8;
  setView(page.view.map((edge, i) => (i % 2 ? y : x) + (edge - (i % 2 ? y : x)) * factor));
}

function dragFrom(event) {
  if (!page.shown) return;
  const canvas = element("discs"), ratio = window.devicePixelRatio || 1, from = [...page.view];
  const scale = Discs.mapping(canvas, from).scale / ratio;
  const move = (to) => {
    const dx = (event.clientX - to.clientX) / scale, dy = (to.clientY - event.clientY) / scale;
    if (!page.isViewWhole) setView([from[0] + dx, from[1] + dy, from[2] + dx, from[3] + dy]);
  };
  canvas.addEventListener("pointermove", move);
  const end = () => canvas.removeEventListener("pointermove", move);
  window.addEventListener("pointerup", end, { once: true });
}

// --------------------------------------------------------------------------------------------

function setTheme(isDark) {
  document.documentElement.classList.toggle("dark", isDark);
  if (page.shown) show();
  drawCurves();
}

function start() {
  const asked = new URLSearchParams(location.search);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  setTheme(asked.has("theme") ? asked.get("theme") === "dark" : dark.matches);
  dark.addEventListener("change", () => setTheme(dark.matches));
  element("theme").onclick = () => setTheme(!document.documentElement.classList.contains("dark"));
  element("back").onclick = () => play(-1);
  element("forth").onclick = () => play(1);
  element("pause").onclick = () => play(0);
  element("slider").oninput = (event) => {
    element("follow").checked = false;
    play(0);
    goTo(Number(event.target.value));
  };
  element("follow").onchange = () => {
    if (element("follow").checked) { play(0); goTo(page.steps.length - 1); }
  };
  element("colour").onchange = show;
  element("column").onchange = async () => { await loadField(); drawCurves(); };
  const canvas = element("discs");
  canvas.addEventListener("wheel", zoomAt, { passive: false });
  canvas.addEventListener("pointerdown", dragFrom);
  canvas.addEventListener("dblclick", () => page.shown && setView(null));
  new ResizeObserver(() => { if (page.shown) show(); drawCurves(); }).observe(canvas);
  document.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName)) return;
    if (event.key === " ") { event.preventDefault(); play(page.direction ? 0 : 1); }
    if (event.key === "b") play(-1);
    if (event.key === "ArrowRight") turn(1);
    if (event.key === "ArrowLeft") turn(-1);
  });
  takeWishes(asked);
  requestAnimationFrame(tick);
  ask();
}

// The address may ask for a colour, a step and a direction: ?colour=psi6&step=120&play=-1
function takeWishes(asked) {
  const colour = asked.get("colour");
  if (["speed", "psi6", "species"].includes(colour)) element("colour").value = colour;
  if (asked.has("step")) {
    element("follow").checked = false;
    page.wish = Number(asked.get("step"));
  }
  if (asked.has("play")) page.wishedPlay = Math.sign(asked.get("play"));
}

// Once there are frames: the last one that is not after the wished step.
function grantWishes() {
  if (page.steps.length === 0) return;
  if (page.wish !== undefined) goTo(page.steps.filter((step) => step <= page.wish).length - 1);
  if (page.wishedPlay) play(page.wishedPlay);
  page.wish = page.wishedPlay = undefined;
}

start();
