// What the colours mean: beside the view, and in pictures and videos of it.

import { gradient, quantity, shades, spoken, type MapName } from "./colors";
import { make } from "./dom";
import type { SceneMessage } from "./message";
import type { Look, View } from "./view";

export interface LegendRow {
  name: string;
  span: string; // from the least to the most
}

export function legendOf(scene: SceneMessage, look: Look, ranges: View["ranges"]): LegendRow[] {
  const { head } = scene;
  const both = head.solids.length > 0 && head.rods.length > 0;
  return (["solids", "rods"] as const).flatMap((kind) => {
    const name = look[kind];
    const range = ranges[kind];
    if (!name || !range) return [];
    const fields = kind === "solids" ? head.solid_fields : head.rod_fields;
    const unit = name === "displacement" ? "m" : fields.find((own) => own.name === name)!.unit;
    return [{ name: (both ? `${kind}: ` : "") + spoken(name), span: `${quantity(range.least, unit)} … ${quantity(range.most, unit)}` }];
  });
}

export function legendNodes(rows: LegendRow[], map: MapName): Node[] {
  return rows.flatMap(({ name, span }) => [
    make("span", { text: name }),
    make("i", { style: `background: ${gradient(map)}` }),
    make("span", { text: span }),
  ]);
}

/** What is seen, with its legend and its time below, of a size that does not change while it is filmed. */
export class Capture {
  readonly canvas = document.createElement("canvas");

  constructor(private readonly view: HTMLCanvasElement) {
    this.canvas.width = view.width;
    this.canvas.height = view.height;
  }

  draw(rows: LegendRow[], map: MapName, when: string): void {
    const { width, height } = this.canvas;
    const context = this.canvas.getContext("2d")!;
    context.drawImage(this.view, 0, 0, width, height);
    const unit = Math.max(Math.round(height / 45), 12); // of letters [px]
    context.font = `${unit}px system-ui, sans-serif`;
    context.textBaseline = "middle";
    const line = (left: number, middle: number, text: string): number => {
      const wide = context.measureText(text).width;
      context.fillStyle = "rgba(20, 24, 32, 0.7)";
      context.fillRect(left, middle - 0.8 * unit, wide + unit, 1.6 * unit);
      context.fillStyle = "#fff";
      context.fillText(text, left + unit / 2, middle);
      return left + wide + unit;
    };
    rows.forEach(({ name, span }, i) => {
      const middle = height - (rows.length - i) * 1.8 * unit;
      const left = line(unit, middle, name);
      const bar = context.createLinearGradient(left, 0, left + 10 * unit, 0);
      const colours = shades(map);
      colours.forEach((colour, k) => bar.addColorStop(k / (colours.length - 1), colour));
      context.fillStyle = bar;
      context.fillRect(left, middle - 0.8 * unit, 10 * unit, 1.6 * unit);
      line(left + 10 * unit, middle, span);
    });
    line(unit, 1.5 * unit, when);
  }
}
