// The program, as tests use it.

import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const root = resolve(fileURLToPath(import.meta.url), "../../..");
export const program = process.env.SINEW ?? join(root, "build/release/sinew");
export const token = "0123456789abcdef0123";

export function sinew(...args: string[]): string {
  return execFileSync(program, args, { cwd: root, encoding: "utf8" });
}

export function folder(): string {
  return mkdtempSync(join(tmpdir(), "sinew-page-"));
}

export class Served {
  private static readonly all = new Set<Served>();

  /** Ends what a test that failed has left. */
  static async stopAll(): Promise<void> {
    for (const own of Served.all) await own.stop();
  }

  private constructor(
    readonly address: string,
    readonly process: ChildProcess,
  ) {}

  /** Starts `sinew view` and waits until it says where it is. */
  static async start(what: string, ...args: string[]): Promise<Served> {
    const known = args.includes("--token") ? [] : ["--token", token];
    const own = spawn(program, ["view", what, ...known, ...args], { cwd: root });
    const address = await new Promise<string>((found, failed) => {
      let told = "";
      let wrong = "";
      own.stderr.on("data", (text: Buffer) => (wrong += text.toString()));
      own.stdout.on("data", (text: Buffer) => {
        told += text.toString();
        const match = /Open (\S+)/.exec(told);
        if (match) found(match[1]!);
      });
      own.on("exit", (code) => failed(new Error(`sinew view ended with ${code}: ${wrong}`)));
    });
    const served = new Served(address, own);
    Served.all.add(served);
    return served;
  }

  get port(): string {
    return new URL(this.address).port;
  }

  async stop(): Promise<void> {
    Served.all.delete(this);
    const ended = new Promise((done) => this.process.on("exit", done));
    this.process.kill("SIGINT");
    await ended;
  }
}
