// Buttons, sliders and choices.

import { mapNames, quantity, shownUnit, spoken, type MapName } from "./colors";
import { make } from "./dom";
import type { FrameMessage, Request, SceneMessage } from "./message";
import type { Look } from "./view";

export interface Hands {
  ask(request: Request): void;
  look(change: Partial<Look>): void;
  camera(preset: "corner" | "front" | "side" | "top"): void;
  picture(): void;
  video(): boolean; // whether it records now
  plots(): void;
  help(): void;
  stiffness(value: number): void; // [N/m] of the hand's spring
}

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Panel {
  private play = make("button");
  private timeline = make("input", { type: "range" });
  private speed = make("select");
  private motors: { slider: HTMLInputElement; said: HTMLElement; auto: HTMLButtonElement; asked: { held: boolean; when: number } }[] = [];
  private goals: HTMLElement[] = [];
  private scene: SceneMessage | null = null;
  private playing = true;
  private hand = 0.5; // where its slider stands

  constructor(
    private readonly place: HTMLElement,
    private readonly hands: Hands,
  ) {
    place.classList.toggle("folded", innerWidth <= 600);
    // Keys are the page's again once the mouse has done its work here.
    place.addEventListener("click", (event) => {
      const at = event.target as HTMLElement;
      if (event.detail > 0 && at.matches("button, input, summary")) at.blur();
    });
  }

  build(scene: SceneMessage, look: Look): void {
    this.scene = scene;
    const { hands } = this;
    document.title = scene.head.title ? `${scene.head.title} – Sinew` : "Sinew";
    this.play = make("button", { class: "play", onclick: () => this.toggle() });
    this.speed = make("select", {
      "aria-label": "Speed",
      title: "Speed, of real time",
      onchange: (event) => hands.ask({ do: "speed", value: Number((event.target as HTMLSelectElement).value) }),
    });
    SPEEDS.forEach((own) => this.speed.append(make("option", { value: own, selected: own === 1, text: `${own}×` })));
    const transport = make(
      "div",
      { class: "row" },
      this.play,
      make("button", { text: "Step", title: "One step (.)", onclick: () => hands.ask({ do: "step" }) }),
      make("button", { text: "Reset", title: "Back to the start (R)", onclick: () => hands.ask({ do: "reset" }) }),
      this.speed,
    );
    const fold = make("button", {
      class: "fold",
      title: "Fold the panel, or unfold it",
      "aria-label": "Fold the panel, or unfold it",
      onclick: () => this.place.classList.toggle("folded"),
    });
    const children: Node[] = [make("h1", { text: scene.head.title || "Sinew" }), fold, transport];
    if (scene.head.mode === "replay") {
      this.timeline = make("input", {
        type: "range",
        id: "timeline",
        "aria-label": "Time",
        min: 0,
        max: Math.max(scene.head.times!.length - 1, 0),
        step: 1,
        value: 0,
        oninput: () => {
          hands.ask({ do: "pause" });
          hands.ask({ do: "seek", frame: Number(this.timeline.value) });
        },
      });
      children.push(this.timeline);
    }
    scene.head.warnings.forEach((text) => children.push(make("p", { class: "warning", text })));
    this.motors = [];
    if (scene.head.mode === "live" && scene.head.actuators.length > 0) children.push(this.motorsOf(scene));
    this.goals = [];
    if (scene.head.targets.length > 0) children.push(this.targetsOf(scene));
    children.push(this.lookOf(scene, look));
    const views = (["corner", "front", "side", "top"] as const).map((own, i) =>
      make("button", { text: own[0]!.toUpperCase() + own.slice(1), title: `Seen from there (${i + 1})`, onclick: () => hands.camera(own) }),
    );
    children.push(make("div", { class: "row" }, ...views));
    const film = make("button", {
      text: "Video",
      title: "Record what is seen",
      onclick: () => (film.textContent = hands.video() ? "Stop" : "Video"),
    });
    film.hidden = typeof MediaRecorder === "undefined";
    children.push(
      make(
        "div",
        { class: "row" },
        make("button", { text: "Picture", title: "Save what is seen (P)", onclick: () => hands.picture() }),
        film,
        make("button", { text: "Plots", title: "Signals over time (G)", onclick: () => hands.plots() }),
        make("button", { text: "?", title: "Help (H)", onclick: () => hands.help() }),
      ),
    );
    this.place.replaceChildren(...children);
    this.setPlaying(true);
  }

  private motorsOf(scene: SceneMessage): HTMLElement {
    const rows = scene.head.actuators.map((own) => {
      const [unit, factor] = shownUnit(own.unit);
      const said = make("output");
      const slider = make("input", {
        type: "range",
        min: own.least,
        max: own.most,
        step: "any",
        "aria-label": `${own.name}: ${own.what}`,
        "data-actuator": own.name,
      });
      const limit = own.limit.map((value) => (value === null ? "no limit" : quantity(value, own.unit)));
      const auto = make("button", {
        text: own.sought ? "inverse" : "scene",
        class: "auto",
        title: own.sought ? "Let the target find it again" : "Let the scene move it again",
        onclick: () => {
          motor.asked = { held: false, when: performance.now() };
          this.hands.ask({ do: "tell", actuator: own.name, value: null });
        },
      });
      const motor = { slider, said, auto, asked: { held: false, when: -Infinity } };
      const hold = (): void => {
        motor.asked = { held: true, when: performance.now() };
        this.hands.ask({ do: "tell", actuator: own.name, value: Number(slider.value) });
      };
      slider.addEventListener("input", hold);
      slider.addEventListener("click", hold); // on the thumb itself, where no input comes
      this.motors.push(motor);
      return make(
        "label",
        { class: "motor", title: `from ${limit[0]} to ${limit[1]}` },
        make("span", { text: own.name }),
        said,
        slider,
        make("small", { text: `${(own.least * factor).toPrecision(3)} … ${(own.most * factor).toPrecision(3)} ${unit}` }),
        auto,
      );
    });
    return make("details", { open: true }, make("summary", { text: "Motors" }), ...rows);
  }

  private targetsOf(scene: SceneMessage): HTMLElement {
    const rows = scene.head.targets.map((own) => {
      const said = make("output");
      this.goals.push(said);
      const row = make("div", { class: "target" }, make("span", { text: own.name }), said);
      if (scene.head.mode === "live") {
        row.append(
          make("button", {
            text: "scene",
            class: "auto",
            title: "Let the scene move it again",
            onclick: () => this.hands.ask({ do: "aim", target: own.name, at: null }),
          }),
        );
      }
      return row;
    });
    return make("details", { open: true }, make("summary", { text: "Targets" }), ...rows);
  }

  private lookOf(scene: SceneMessage, look: Look): HTMLElement {
    const { hands } = this;
    const choice = (name: string, values: string[], chosen: string, take: (value: string) => void): HTMLElement => {
      const own = make("select", { "aria-label": name, onchange: (event) => take((event.target as HTMLSelectElement).value) });
      values.forEach((value) => own.append(make("option", { value, selected: value === chosen, text: spoken(value) || "plain" })));
      return make("label", {}, make("span", { text: name }), own);
    };
    const range = (name: string, value: number, take: (value: number) => void, said?: (value: number) => string): HTMLElement => {
      const text = make("small", { text: said?.(value) ?? "" });
      const slider = make("input", {
        type: "range", min: 0, max: 1, step: 0.01, value, "aria-label": name,
        oninput: () => {
          take(Number(slider.value));
          text.textContent = said?.(Number(slider.value)) ?? "";
        },
      });
      return make("label", {}, make("span", { text: name }), slider, ...(said ? [text] : []));
    };
    const box = (name: string, checked: boolean, take: (value: boolean) => void): HTMLElement =>
      make(
        "label",
        { class: "box" },
        make("input", { type: "checkbox", checked, onchange: (event) => take((event.target as HTMLInputElement).checked) }),
        name,
      );
    const sides = ["from x", "from y", "from z", "from −x", "from −y", "from −z"];
    const rows: Node[] = [make("summary", { text: "Look" })];
    if (scene.head.solids.length > 0) {
      const fields = ["", "displacement", ...scene.head.solid_fields.map((own) => own.name)];
      rows.push(choice("Solids", fields, look.solids, (value) => hands.look({ solids: value })));
    }
    if (scene.head.rods.length > 0) {
      const fields = ["", ...scene.head.rod_fields.map((own) => own.name)];
      rows.push(choice("Rods", fields, look.rods, (value) => hands.look({ rods: value })));
    }
    rows.push(choice("Colours", mapNames, look.map, (value) => hands.look({ map: value as MapName })));
    if (scene.head.solids.length > 0) {
      rows.push(range("Opacity", look.opacity, (value) => hands.look({ opacity: value })));
      rows.push(range("Section", look.section, (value) => hands.look({ section: value })));
      const taken = (value: string): void => {
        const number = sides.indexOf(value);
        hands.look({ sectionAxis: (number % 3) as 0 | 1 | 2, sectionSide: number < 3 ? 1 : -1 });
      };
      rows.push(choice("cut", sides, sides[look.sectionAxis + (look.sectionSide > 0 ? 0 : 3)]!, taken));
    }
    if (scene.head.mode === "live" && scene.head.solids.length > 0) {
      const spring = (value: number): number => Math.min(2500 * scene.head.size ** 2 * 10 ** (4 * value - 2), 1e6);
      const take = (value: number): void => {
        this.hand = value;
        hands.stiffness(spring(value));
      };
      const stiffness = range("Hand", this.hand, take, (value) => quantity(spring(value), "N/m"));
      stiffness.title = "How stiff the spring is by which the mouse pulls at the body";
      take(this.hand);
      rows.push(stiffness);
    }
    rows.push(
      make(
        "div",
        { class: "row" },
        box("edges", look.edges, (value) => hands.look({ edges: value })),
        box("points", look.points, (value) => hands.look({ points: value })),
        box("forces", look.contacts, (value) => hands.look({ contacts: value })),
        ...(scene.head.outputs.length > 0 ? [box("trails", look.trails, (value) => hands.look({ trails: value }))] : []),
      ),
    );
    return make("details", { open: true }, ...rows);
  }

  toggle(): void {
    this.hands.ask({ do: this.playing ? "pause" : "play" });
  }

  private setPlaying(yes: boolean): void {
    this.playing = yes;
    const text = yes ? "Pause" : "Play";
    if (this.play.textContent !== text) this.play.textContent = text;
    this.play.title = `${text} (space)`;
  }

  show(frame: FrameMessage): void {
    const scene = this.scene!;
    if (frame.head.playing !== undefined) this.setPlaying(frame.head.playing);
    if (SPEEDS.includes(frame.head.speed ?? 0) && document.activeElement !== this.speed) this.speed.value = String(frame.head.speed);
    if (scene.head.mode === "replay" && document.activeElement !== this.timeline) this.timeline.value = String(frame.head.frame);
    const told = frame.doubles("told");
    this.motors.forEach((own, i) => {
      const { unit, name } = scene.head.actuators[i]!;
      own.said.textContent = quantity(told[i]!, unit);
      // Frames that were on their way when it was asked do not know of it yet.
      const mine = frame.head.mine !== undefined && name in frame.head.mine;
      const held = own.slider.matches(":active") || (performance.now() - own.asked.when < 1000 ? own.asked.held : mine);
      own.auto.style.visibility = held ? "visible" : "hidden";
      if (!held) own.slider.value = String(told[i]!);
    });
    const goals = frame.doubles("goals");
    this.goals.forEach((own, i) => {
      const target = scene.head.targets[i]!;
      const at = Array.from(goals.subarray(target.first, target.first + target.size));
      const [unit, factor] = shownUnit(target.unit);
      const shown = (value: number): string => (value * factor).toFixed(1).replace(/^-(0\.0)$/, "$1");
      own.textContent = `${at.map((value, k) => (target.weights[k] === 0 ? "–" : shown(value))).join(", ")} ${unit}`;
      own.title = target.weights.includes(0) ? "– is free" : "";
    });
  }
}
