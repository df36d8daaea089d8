// Signals over time, as they come.

import uPlot from "uplot";

import { palette, shownUnit, tickText, withoutRounding } from "./colors";
import { download, make } from "./dom";
import type { FrameMessage, SceneMessage } from "./message";

const LONGEST = 6000; // points kept; older ones go

/** What is drawn together: signals of one unit whose names end alike. */
interface Group {
  name: string;
  unit: string;
  signals: number[];
}

function groupsOf(scene: SceneMessage): Group[] {
  const kinds: [string, (name: string) => boolean][] = [
    ["Forces of motors", (name) => name.endsWith(".force") || name.endsWith(".torque")],
    ["Motors", (name) => name.endsWith(".displacement") || name.endsWith(".angle")],
    ["How far targets are off", (name) => name.endsWith(".error")],
    ["Energies", (name) => name.startsWith("energy.")],
    ["Outputs", (name) => !name.includes(".target")],
  ];
  const left = new Set(scene.head.signals.keys());
  const all: Group[] = [];
  for (const [name, belongs] of kinds) {
    const units = new Map<string, number[]>();
    for (const i of left) {
      const own = scene.head.signals[i]!;
      if (!belongs(own.name)) continue;
      units.set(own.unit, [...(units.get(own.unit) ?? []), i]);
      left.delete(i);
    }
    for (const [unit, signals] of units) all.push({ name, unit, signals });
  }
  return all;
}

export class Plots {
  private groups: Group[] = [];
  private scene: SceneMessage | null = null;
  private time: number[] = [];
  private complete = false; // all of a run is there
  private values: number[][] = [];
  private shown: { group: number; plot: uPlot | null; place: HTMLElement }[] = [];
  private drawn = 0;

  constructor(
    private readonly place: HTMLElement,
    private readonly chosen: () => void,
  ) {}

  /** Whether they are plotted: to tell them costs the simulation more than all the rest. */
  energies(): boolean {
    return this.shown.some((own) => this.groups[own.group]!.name === "Energies");
  }

  build(scene: SceneMessage): void {
    this.shown.forEach((own) => own.plot?.destroy());
    this.scene = scene;
    this.groups = groupsOf(scene);
    this.clear();
    const times = scene.doubles("history.times");
    this.complete = times.length > 0;
    if (this.complete) {
      const count = scene.head.signals.length;
      const values = scene.doubles("history.values");
      this.time = Array.from(times);
      this.values = scene.head.signals.map((_, i) => this.time.map((_, k) => values[k * count + i]!));
    }
    this.place.replaceChildren();
    const first = this.groups.findIndex((own) => own.name.startsWith("How far"));
    const choices = [0, first > 0 ? first : Math.min(1, this.groups.length - 1)];
    this.shown = choices.slice(0, this.groups.length).map((group) => {
      const place = make("div", { class: "plot" });
      const own = { group, plot: null as uPlot | null, place };
      const choice = make("select", {
        "aria-label": "What is plotted",
        onchange: (event) => {
          own.group = Number((event.target as HTMLSelectElement).value);
          this.make(own);
          this.chosen();
        },
      });
      this.groups.forEach((one, i) =>
        choice.append(make("option", { value: i, selected: i === group, text: `${one.name} [${shownUnit(one.unit)[0]}]` })),
      );
      place.append(choice);
      this.place.append(place);
      this.make(own);
      return own;
    });
    this.place.append(make("button", { text: "Save as CSV", title: "What is plotted, in SI, as often as it was seen (signals.csv of a run has every step)", onclick: () => this.save() }));
  }

  clear(): void {
    this.time = [];
    this.values = this.scene?.head.signals.map(() => []) ?? [];
  }

  private make(own: { group: number; plot: uPlot | null; place: HTMLElement }): void {
    own.plot?.destroy();
    const group = this.groups[own.group]!;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    const ink = dark ? "#c8ccd4" : "#30343c";
    const axis = { stroke: ink, grid: { stroke: dark ? "#333a46" : "#dfe3e8", width: 1 }, font: "11px system-ui", size: 48 };
    own.plot = new uPlot(
      {
        width: own.place.clientWidth || 360,
        height: 150,
        legend: { live: true },
        cursor: { drag: { x: false, y: false } },
        scales: { x: { time: false } },
        axes: [{ ...axis, size: 28 }, { ...axis, values: (_: uPlot, ticks: number[]) => ticks.map(tickText) }],
        series: [
          { label: "t [s]" },
          ...group.signals.map((i, k) => ({
            label: this.scene!.head.signals[i]!.name,
            stroke: palette[k % palette.length]!,
            width: 1.5,
            points: { show: false },
          })),
        ],
      },
      this.dataOf(group),
      own.place,
    );
  }

  private dataOf(group: Group): uPlot.AlignedData {
    const factor = shownUnit(group.unit)[1];
    return [this.time, ...group.signals.map((i) => this.values[i]!.map((value) => (Number.isNaN(value) ? null : factor * withoutRounding(value))))];
  }

  add(frame: FrameMessage): void {
    if (this.complete) return;
    const { time } = frame.head;
    const last = this.time[this.time.length - 1];
    if (last !== undefined && time < last) this.clear(); // it began again
    const known = time === last ? 1 : 0;
    const signals = frame.doubles("signals");
    this.time.splice(this.time.length - known, known, time);
    this.values.forEach((own, i) => own.splice(own.length - known, known, signals[i]!));
    if (this.time.length > LONGEST) {
      this.time.splice(0, LONGEST / 10);
      this.values.forEach((own) => own.splice(0, LONGEST / 10));
    }
    const now = performance.now();
    if (this.place.hidden || now - this.drawn < 100) return;
    this.drawn = now;
    this.draw();
  }

  draw(): void {
    for (const own of this.shown) {
      if (own.plot && own.place.clientWidth > 0 && own.plot.width !== own.place.clientWidth) {
        own.plot.setSize({ width: own.place.clientWidth, height: 150 });
      }
      own.plot?.setData(this.dataOf(this.groups[own.group]!));
    }
  }

  /** What is plotted, in SI. */
  csv(): string {
    const signals = [...new Set(this.shown.flatMap((own) => this.groups[own.group]!.signals))];
    const names = signals.map((i) => this.scene!.head.signals[i]!).map(({ name, unit }) => `${name} [${unit}]`);
    const rows = this.time.map((time, k) => [time, ...signals.map((i) => this.values[i]![k]!)].join(","));
    return [["time [s]", ...names].join(","), ...rows].join("\n") + "\n";
  }

  private save(): void {
    download("sinew.csv", new Blob([this.csv()], { type: "text/csv" }));
  }
}
