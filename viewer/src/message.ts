// What the server says (src/sinew/live/message.hpp): a JSON head and arrays that it names.

export type Vector = [number, number, number];

export interface Actuator {
  name: string;
  what: string;
  unit: string;
  least: number;
  most: number;
  sought: boolean;
  limit: [number | null, number | null];
}

export interface Target {
  name: string;
  first: number;
  size: number;
  unit: string;
  position: boolean;
  weights: number[]; // 0: the component is free
}

export interface Quantity {
  name: string;
  unit: string;
}

export interface SceneHead {
  mode: "live" | "replay";
  title: string;
  warnings: string[];
  size: number;
  middle: Vector;
  up: Vector;
  times?: number[];
  solids: { name: string }[];
  rods: { name: string; samples: number }[];
  bodies: { name: string; fixed: boolean; ground: boolean; round: boolean }[];
  actuators: Actuator[];
  targets: Target[];
  outputs: string[];
  signals: Quantity[];
  solid_fields: Quantity[];
  rod_fields: Quantity[];
}

export interface FrameHead {
  frame: number;
  time: number;
  when: string;
  status: string;
  targets: string;
  newton: number;
  scales: number[];
  halvings?: number;
  playing?: boolean;
  speed?: number;
  contacts?: number;
  step_ms?: number;
  frame_ms?: number;
  realtime?: number;
  warnings?: string[]; // of this step
  trouble?: string;
  mine?: Record<string, number>;
}

type Numbers = Float32Array | Float64Array | Int16Array | Uint32Array;

export class Message<Head> {
  constructor(
    readonly head: Head,
    private readonly arrays: Map<string, Numbers>,
  ) {}

  /** An array of numbers of a type; empty where the message has none of the name. */
  floats(name: string): Float32Array {
    const own = this.arrays.get(name);
    return own instanceof Float32Array ? own : new Float32Array();
  }
  doubles(name: string): Float64Array {
    const own = this.arrays.get(name);
    return own instanceof Float64Array ? own : new Float64Array();
  }
  shorts(name: string): Int16Array {
    const own = this.arrays.get(name);
    return own instanceof Int16Array ? own : new Int16Array();
  }
  whole(name: string): Uint32Array {
    const own = this.arrays.get(name);
    return own instanceof Uint32Array ? own : new Uint32Array();
  }
}

export type SceneMessage = Message<SceneHead>;
export type FrameMessage = Message<FrameHead>;
export type Any = { kind: "scene"; message: SceneMessage } | { kind: "frame"; message: FrameMessage };

const kinds = { f32: Float32Array, f64: Float64Array, i16: Int16Array, u32: Uint32Array };

/** `bytes` begin on a multiple of 8 of their buffer. */
export function decode(bytes: Uint8Array<ArrayBuffer>): Any {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const kind = view.getUint32(0, true);
  const size = view.getUint32(4, true);
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(8, 8 + size)));
  const arrays = new Map<string, Numbers>();
  for (const own of head.arrays as { name: string; type: keyof typeof kinds; at: number; count: number }[]) {
    arrays.set(own.name, new kinds[own.type](bytes.buffer, bytes.byteOffset + 8 + size + own.at, own.count));
  }
  return kind === 1
    ? { kind: "scene", message: new Message<SceneHead>(head, arrays) }
    : { kind: "frame", message: new Message<FrameHead>(head, arrays) };
}

export type Request =
  | { do: "play" | "pause" | "step" | "reset" | "release" }
  | { do: "speed"; value: number }
  | { do: "tell"; actuator: string; value: number | null }
  | { do: "aim"; target: string; at: number[] | null }
  | { do: "grip"; solid: string; node: number; to: number[]; stiffness: number }
  | { do: "seek"; frame: number }
  | { do: "show"; solids: string; rods: string; energies: boolean }
  | { do: "ack"; frame: number };
