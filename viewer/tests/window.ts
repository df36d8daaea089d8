// What tests look at inside the page: window.sinew of src/main.ts.

export interface Window {
  sinew: {
    pick: (x: number, y: number) => { kind: string; number: number } | null;
    tally: { frames: number; draws: number; scriptMs: number; drawMs: number; worstMs: number };
    scene(): { mode: string; actuators: { name: string; most: number }[]; times?: number[] };
    frame(): {
      time: number;
      frame: number;
      frame_ms: number;
      step_ms: number;
      targets: string;
      playing: boolean;
      trouble: string;
      mine: Record<string, number>;
    };
    told(): number[];
    goals(): number[];
    outputs(): number[];
    project(x: number, y: number, z: number): { x: number; y: number };
    csv(): string;
    trails(): { outputs: number[]; targets: number[] };
  };
}
