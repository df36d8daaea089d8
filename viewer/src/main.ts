// The page: what comes goes to the view, the panel and the plots; what hands do goes back.

import "uplot/dist/uPlot.min.css";
import * as THREE from "three";

import { download, make } from "./dom";
import { Capture, legendNodes, legendOf } from "./legend";
import type { Any, FrameMessage, Request, SceneMessage } from "./message";
import { Panel } from "./panel";
import { Plots } from "./plots";
import { connect, embedded, type Source } from "./source";
import { View, type Hit, type Look } from "./view";

const find = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const canvas = find<HTMLCanvasElement>("view");
const view = looking();
const plots = new Plots(find("plots"), () => askToShow());
const status = find("status");
const trouble = find("trouble");
const legend = find("legend");
const help = find<HTMLDialogElement>("help");

/** The view, or why there is none. */
function looking(): View {
  try {
    return new View(canvas);
  } catch (error) {
    find("status").textContent = "This browser does not draw in three dimensions (WebGL), which the page needs. Try another one, or switch it on.";
    throw error;
  }
}

let source: Source | null = null;
let scene: SceneMessage | null = null;
let latest: FrameMessage | null = null;
let fresh = false;
let stiffness = 100;
let film: { recorder: MediaRecorder; capture: Capture } | null = null;
let refusal = "";
let touched = false; // somebody has dragged something
let over: { x: number; y: number } | null = null; // where the pointer is, if nobody has looked what is there

/** What came and was drawn; means over about 20 pictures, in ms: of our own script, and of drawing them (three.js and what it calls). */
const tally = { frames: 0, draws: 0, scriptMs: 0, drawMs: 0, worstMs: 0 };

const ask = (request: Request): void => source?.ask(request);

function askToShow(): void {
  const { solids, rods } = view.look;
  ask({ do: "show", solids: solids === "displacement" ? "" : solids, rods, energies: plots.energies() });
}

/** Of what is saved: the scene's title. */
function fileName(): string {
  return (scene?.head.title ?? "").toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "_").replace(/^_|_$/g, "") || "sinew";
}

/** What is seen now, onto what is kept of it. */
function captured(capture: Capture): void {
  if (scene) capture.draw(legendOf(scene, view.look, view.ranges), view.look.map, latest?.head.when ?? "");
}

function picture(): void {
  const capture = new Capture(canvas);
  captured(capture);
  capture.canvas.toBlob((blob) => blob && download(`${fileName()}.png`, blob));
}

/** Begins a video, or ends it and saves it; returns whether it records now. */
function video(): boolean {
  if (film) {
    film.recorder.stop();
    film = null;
    return false;
  }
  const type = ["video/webm", "video/mp4"].find((own) => MediaRecorder.isTypeSupported(own));
  if (!type) return false;
  const parts: Blob[] = [];
  const capture = new Capture(canvas);
  captured(capture);
  const recorder = new MediaRecorder(capture.canvas.captureStream(60), { mimeType: type });
  recorder.ondataavailable = (event) => parts.push(event.data);
  recorder.onstop = () => download(`${fileName()}.${type.slice(6)}`, new Blob(parts, { type }));
  recorder.start();
  film = { recorder, capture };
  return true;
}

function togglePlots(): void {
  const place = find("plots");
  place.hidden = !place.hidden;
  view.leave(place.offsetWidth);
  plots.draw();
}

const panel = new Panel(find("panel"), {
  ask,
  look(change: Partial<Look>) {
    Object.assign(view.look, change);
    if ("solids" in change || "rods" in change) askToShow();
    view.apply();
    showLegend();
  },
  camera: (preset) => view.preset(preset),
  picture,
  video,
  plots: togglePlots,
  help: () => help.showModal(),
  stiffness: (value) => (stiffness = value),
});

// What comes.

function take(own: Any): void {
  if (own.kind === "scene") {
    scene = own.message;
    latest = null;
    held = null;
    view.build(scene);
    panel.build(scene, view.look);
    plots.build(scene);
    tellHelp(scene.head.mode === "live");
    askToShow();
  } else {
    latest = own.message;
    fresh = true;
    tally.frames += 1;
  }
}

function tick(): void {
  requestAnimationFrame(tick);
  const begin = performance.now();
  if (over && !held) {
    if (scene?.head.mode === "live") canvas.classList.toggle("over", view.pick(over.x, over.y) !== null);
    over = null;
  }
  if (fresh && latest && scene) {
    fresh = false;
    ask({ do: "ack", frame: latest.head.frame }); // first: whatever becomes of this one, others are to come
    view.show(latest);
    showHand();
    panel.show(latest);
    plots.add(latest);
    showStatus();
    showLegend();
  }
  const ready = performance.now();
  if (view.draw()) {
    const end = performance.now();
    const mean = (own: number, value: number): number => (tally.draws === 0 ? value : 0.95 * own + 0.05 * value);
    tally.scriptMs = mean(tally.scriptMs, ready - begin);
    tally.drawMs = mean(tally.drawMs, end - ready);
    tally.worstMs = Math.max(tally.worstMs, ready - begin);
    tally.draws += 1;
    if (film) captured(film.capture);
  }
}

function showStatus(): void {
  const { head } = latest!;
  const live = scene!.head.mode === "live";
  const parts: [string, string][] = [[head.when, "time"]];
  if (head.realtime !== undefined && head.playing) parts.push([`${head.realtime.toFixed(2)}× real time`, "realtime"]);
  if (head.step_ms !== undefined) parts.push([`step ${head.step_ms.toFixed(2)} ms`, "step"]);
  parts.push([`${head.newton} Newton`, "newton"]);
  if (head.contacts) parts.push([`${head.contacts} contacts`, "contacts"]);
  const warnings = head.warnings ?? [];
  parts.push(["●", head.trouble ? "dot stopped" : warnings.length > 0 ? "dot warned" : "dot sound"]);
  parts.push([head.status, "state"]);
  for (const text of warnings) parts.push([text, "warning"]);
  if (head.halvings) parts.push([`step halved ${head.halvings}×`, "warning"]);
  if (/^reached(?! by)/.test(head.targets)) parts.push([head.targets, "fine"]);
  else if (head.targets) parts.push([`${farOff()}${head.targets.replaceAll("actuators.", "")}`, "warning"]);
  if (!touched && live && head.playing) {
    const what = [...(scene!.head.targets.some((own) => own.position) ? ["the red ball"] : []), ...(scene!.head.solids.length > 0 ? ["the body"] : [])];
    if (what.length > 0) parts.push([`Drag ${what.join(", or ")}`, "hint"]);
  }
  if (scene!.head.targets.length > 0 && Object.keys(head.mine ?? {}).length > 0) {
    parts.push(["targets are left alone while motors are told", "warning"]);
  }
  if (refusal) parts.push([refusal, "warning"]);
  status.replaceChildren(...parts.map(([text, name]) => make("span", { class: name, text })));
  const stopped = !head.trouble ? "" : live ? `Stopped: ${head.trouble} Play tries again, Reset begins anew.` : head.trouble;
  trouble.hidden = !stopped;
  if (trouble.textContent !== stopped) trouble.textContent = stopped;
}

/** "tip 58.2 mm off: ", of the position that is farthest from its target. */
function farOff(): string {
  const goals = latest!.doubles("goals");
  const outputs = latest!.floats("outputs");
  let most = 0;
  let name = "";
  for (const target of scene!.head.targets.filter((own) => own.position)) {
    const at = scene!.head.outputs.indexOf(target.name);
    const off = Math.hypot(...target.weights.map((weight, k) => (weight === 0 ? 0 : goals[target.first + k]! - outputs[3 * at + k]!)));
    if (off > most) [most, name] = [off, target.name];
  }
  return most > 5e-5 ? `${name} ${(1e3 * most).toFixed(1)} mm off: ` : "";
}

function showLegend(): void {
  if (!scene) return;
  const rows = legendOf(scene, view.look, view.ranges);
  legend.hidden = rows.length === 0;
  legend.replaceChildren(...legendNodes(rows, view.look.map));
}

const listener = {
  message: take,
  refused(why: string) {
    refusal = why;
    if (latest) showStatus();
    setTimeout(() => (refusal = ""), 4000);
  },
  connected(yes: boolean, why = "") {
    document.body.classList.toggle("lost", !yes);
    if (!yes) release();
    if (!yes) status.replaceChildren(make("span", { class: "warning", text: why }));
  },
};

// What hands do.

let held: { hit: Hit; to: THREE.Vector3; pointer: number } | null = null;

function place(event: PointerEvent): { x: number; y: number } {
  const box = canvas.getBoundingClientRect();
  return { x: event.clientX - box.left, y: event.clientY - box.top };
}

/** From what is held to the hand; targets follow it only as time goes on. */
function showHand(): void {
  if (!held) return;
  const { kind, number, node } = held.hit;
  view.showHand([kind === "solid" ? view.cornerPosition(number, node) : view.goalPosition(number), held.to]);
}

function pull(): void {
  if (!held || !scene) return;
  const to = held.to.toArray();
  if (held.hit.kind === "target") {
    const targets = scene.head.targets.filter((own) => own.position);
    ask({ do: "aim", target: targets[held.hit.number]!.name, at: to });
    showHand();
  } else {
    const solid = scene.head.solids[held.hit.number]!.name;
    ask({ do: "grip", solid, node: view.meshNode(held.hit.number, held.hit.node), to, stiffness });
    showHand();
  }
}

canvas.addEventListener(
  "pointerdown",
  (event) => {
    if (event.button !== 0 || scene?.head.mode !== "live" || event.altKey) return;
    const { x, y } = place(event);
    const hit = view.pick(x, y);
    if (!hit) return;
    held = { hit, to: hit.point.clone(), pointer: event.pointerId };
    touched = true;
    view.controls.enabled = false;
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add("holding");
  },
  { capture: true },
);
canvas.addEventListener("pointermove", (event) => {
  const { x, y } = place(event);
  if (!held) {
    over = event.buttons === 0 ? { x, y } : null;
    return;
  }
  held.to = view.under(x, y, held.to);
  pull();
});
const release = (): void => {
  if (!held) return;
  if (held.hit.kind === "solid") ask({ do: "release" });
  held = null;
  view.controls.enabled = true;
  view.showHand(null);
  canvas.classList.remove("holding");
};
canvas.addEventListener("pointerup", release);
canvas.addEventListener("pointercancel", release);

/** What can be done with what is shown. */
function tellHelp(live: boolean): void {
  const all: [string, string, "live"?][] = [
    ["Drag a red ball", "moves the target: the motors follow, as far as their limits allow", "live"],
    ["Drag the body", "pulls at it by a spring (red); Hand in the panel is its stiffness", "live"],
    [live ? "Drag beside it, or with Alt" : "Drag", "turns the view; right button or two fingers shift it, the wheel comes nearer"],
    ["Sliders", "tell a motor what to do; the button below gives it back", "live"],
    ["Space, ., R", "play or pause, one step, reset"],
    ["Section", "cuts solids open; Picture and Video save what is seen, Plots has the numbers"],
    ["1 2 3 4", "views from the corner, front, side, top"],
    ["P, G, H", "picture, plots, this help"],
  ];
  help.replaceChildren(
    make("h2", { text: "What you can do" }),
    make("dl", {}, ...all.filter((own) => live || !own[2]).flatMap(([term, text]) => [make("dt", { text: term }), make("dd", { text })])),
    make("button", { text: "Close", onclick: () => help.close() }),
  );
}

addEventListener("keydown", (event) => {
  const at = event.target as HTMLElement;
  if (event.ctrlKey || event.metaKey || event.altKey || at.matches("select, dialog *")) return;
  if ((event.key === " " || event.key === "Enter") && at.matches("input, button, summary")) return; // theirs
  const presets = { "1": "corner", "2": "front", "3": "side", "4": "top" } as const;
  if (event.key in presets) view.preset(presets[event.key as keyof typeof presets]);
  else if (event.key === " ") panel.toggle();
  else if (event.key === ".") ask({ do: "step" });
  else if (event.key === "r" || event.key === "R") ask({ do: "reset" });
  else if (event.key === "p" || event.key === "P") picture();
  else if (event.key === "g" || event.key === "G") togglePlots();
  else if (event.key === "h" || event.key === "H" || event.key === "?") help.showModal();
  else return;
  event.preventDefault();
});

declare global {
  interface Window {
    sinew: unknown;
  }
}
new ResizeObserver(() => document.body.style.setProperty("--below", `${find("status").offsetHeight + 20}px`)).observe(find("status"));
window.sinew = {
  pick: (x: number, y: number) => view.pick(x, y),
  tally,
  scene: () => scene?.head,
  frame: () => latest?.head,
  told: () => Array.from(latest?.doubles("told") ?? []),
  goals: () => Array.from(latest?.doubles("goals") ?? []),
  outputs: () => Array.from(latest?.floats("outputs") ?? []),
  project: (x: number, y: number, z: number) => view.project(new THREE.Vector3(x, y, z)),
  csv: () => plots.csv(),
  trails: () => view.trailLengths(),
};

const run = document.getElementById("run");
if (run) {
  embedded(run.textContent ?? "", listener).then((own) => {
    source = own;
    askToShow();
  }, (error: unknown) => (status.textContent = `The run in this file cannot be read: ${String(error)}`));
} else {
  source = connect(listener);
}
requestAnimationFrame(tick);
