// Colour maps that people who see colours differently can read, as 9 colours evenly apart (viridis and cividis, by S. van
// der Walt, N. Smith and J. Nunez; cividis to about a hundredth).

const maps = {
  viridis: ["440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725"],
  cividis: ["00224e", "1f3a6e", "434e6c", "61656f", "7d7c78", "9b9476", "bcae6c", "ddca58", "fee838"],
  grey: ["202020", "383838", "505050", "686868", "808080", "9a9a9a", "b4b4b4", "d0d0d0", "f0f0f0"],
};
export type MapName = keyof typeof maps;
export const mapNames = Object.keys(maps) as MapName[];

/** 256 colours, red, green and blue from 0 to 1, one after the other: as light, which three.js counts in, not as maps tell them, for the eye. */
export function table(name: MapName): Float32Array {
  const stops = maps[name].map((own) => [0, 2, 4].map((at) => parseInt(own.slice(at, at + 2), 16) / 255));
  const all = new Float32Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (stops.length - 1);
    const before = Math.min(Math.floor(at), stops.length - 2);
    for (let k = 0; k < 3; ++k) {
      all[3 * i + k] = Math.pow(stops[before]![k]! + (at - before) * (stops[before + 1]![k]! - stops[before]![k]!), 2.2);
    }
  }
  return all;
}

/** Colours that are evenly apart, as style sheets call them. */
export function shades(name: MapName): string[] {
  return maps[name].map((own) => `#${own}`);
}

/** What a style sheet calls it, from left to right. */
export function gradient(name: MapName): string {
  return `linear-gradient(to right, ${shades(name).join(", ")})`;
}

/** Six colours of Okabe and Ito, for things side by side. */
export const palette = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/** A field's name as people say it. */
export function spoken(name: string): string {
  const own: Record<string, string> = { von_mises: "von Mises stress", principal_stress: "max. principal stress" };
  return own[name] ?? name.replaceAll("_", " ");
}

/** A value in SI as it is shown: what is nothing but rounding is 0. */
export function withoutRounding(value: number): number {
  return Math.abs(value) < 1e-10 ? 0 : value;
}

/** A number beside an axis, in few characters; ticks are round. */
export function tickText(value: number): string {
  const text = String(Number(value.toPrecision(6)));
  if (text.replace("-", "").length <= 7) return text;
  return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
}

/** A number with its unit, as people write it: 0.0123 m is 12.3 mm. */
export function quantity(value: number, unit: string): string {
  const shown: Record<string, [string, number]> = { m: ["mm", 1e3], rad: ["deg", 180 / Math.PI], "1": ["", 1] };
  let [name, factor] = shown[unit] ?? [unit, 1];
  if (unit === "Pa") {
    const size = Math.abs(value);
    if (size >= 1e6) [name, factor] = ["MPa", 1e-6];
    else if (size >= 1e3) [name, factor] = ["kPa", 1e-3];
  }
  const own = value * factor;
  const text = withoutRounding(value) === 0 ? "0" : Math.abs(own) < 1e-3 || Math.abs(own) >= 1e5 ? own.toExponential(2) : own.toPrecision(4);
  return name ? `${text} ${name}` : text;
}

export function shownUnit(unit: string): [string, number] {
  const known: Record<string, [string, number]> = { m: ["mm", 1e3], rad: ["deg", 180 / Math.PI] };
  return known[unit] ?? [unit, 1];
}
