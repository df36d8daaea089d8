// Where messages come from: a server, or the file itself.

import { decode, type Any, type Request } from "./message";

export interface Source {
  /** Asks for something; what is asked while there is no connection is lost. */
  ask(request: Request): void;
}

export interface Listener {
  message(own: Any): void;
  refused(why: string): void;
  /** Whether somebody is at the other end; if not, why, for people. */
  connected(yes: boolean, why?: string): void;
}

/** A connection that is made again when it breaks. */
export function connect(listener: Listener): Source {
  let socket: WebSocket | null = null;
  const address = new URL("live", location.href);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  address.search = location.search;
  const open = (): void => {
    const own = new WebSocket(address);
    own.binaryType = "arraybuffer";
    own.onopen = () => {
      socket = own;
      listener.connected(true);
    };
    own.onmessage = (event: MessageEvent<ArrayBuffer | string>) => {
      if (typeof event.data === "string") listener.refused(String(JSON.parse(event.data).refused));
      else listener.message(decode(new Uint8Array(event.data)));
    };
    own.onclose = async (event) => {
      const came = socket !== null;
      socket = null;
      let why = "No connection; trying again. Does `sinew view` still run?";
      if (event.code === 1013) why = "Too many pages look on already; trying again.";
      else if (!came && (await foreign())) why = "Another `sinew view` runs there now: open the address that it printed.";
      listener.connected(false, why);
      setTimeout(open, 700);
    };
  };
  open();
  return { ask: (request) => socket?.send(JSON.stringify(request)) };
}

/** Whether somebody is there who does not know this page's token. */
async function foreign(): Promise<boolean> {
  return fetch(location.href).then(
    (answer) => answer.status === 403,
    () => false,
  );
}

async function inflate(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const packed = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The run that `sinew export` put into this file: played here. */
export async function embedded(text: string, listener: Listener): Promise<Source> {
  const all = await inflate(text.trim());
  const view = new DataView(all.buffer);
  const messages: Uint8Array<ArrayBuffer>[] = [];
  for (let at = 0; at < all.length; ) {
    const size = view.getUint32(at, true);
    messages.push(all.slice(at + 4, at + 4 + size)); // a copy begins where arrays may
    at += 4 + size;
  }
  const scene = decode(messages[0]!);
  if (scene.kind !== "scene") throw new Error("the file holds no run");
  const frames = messages.slice(1).map((bytes) => {
    const own = decode(bytes);
    if (own.kind !== "frame") throw new Error("the file holds no run");
    return own;
  });
  const times = frames.map((own) => own.message.head.time);
  scene.message.head.times = times;
  let number = 0;
  let time = times[0]!;
  let playing = true;
  let speed = 1;
  let last = performance.now();
  const tell = (): void => {
    const own = frames[number]!;
    Object.assign(own.message.head, { frame: number, playing, speed });
    listener.message(own);
  };
  const go = (to: number): void => {
    number = Math.max(0, Math.min(to, frames.length - 1));
    time = times[number]!;
    tell();
  };
  const tick = (now: number): void => {
    const passed = Math.min((now - last) / 1000, 0.1);
    last = now;
    if (playing) {
      time += passed * speed;
      const before = number;
      while (number < frames.length - 1 && times[number + 1]! <= time) ++number;
      if (number === frames.length - 1) playing = false;
      if (number !== before || !playing) tell();
    }
    requestAnimationFrame(tick);
  };
  listener.connected(true);
  listener.message(scene);
  tell();
  requestAnimationFrame(tick);
  return {
    ask: (request) => {
      if (request.do === "play") {
        playing = true;
        if (number === frames.length - 1) go(0);
        else tell();
      } else if (request.do === "pause") {
        playing = false;
        tell();
      } else if (request.do === "step") {
        playing = false;
        go(number + 1);
      } else if (request.do === "reset") go(0);
      else if (request.do === "seek") go(request.frame);
      else if (request.do === "speed") {
        speed = request.value;
        tell();
      }
    },
  };
}
