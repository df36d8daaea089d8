// The page against the program, in a browser.

import { expect, test, type Page } from "@playwright/test";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";

import { tickText } from "../src/colors";
import { folder, root, Served, sinew } from "./server";
import type { Window as Own } from "./window";

declare const window: Own;

test("labels of axes are short, and not rounded", () => {
  expect([0, 0.4, -0.00125, 0.000375, 2.5e-7, 99_999, 12.5e6, -7.5e11].map(tickText)).toEqual(
    ["0", "0.4", "-0.00125", "3.75e-4", "2.5e-7", "99999", "1.25e7", "-7.5e11"]);
});

/** Opens it and waits for frames; complaints of the page fail the test. */
async function open(page: Page, address: string): Promise<void> {
  page.on("pageerror", (error) => {
    throw error;
  });
  await page.goto(address);
  await page.waitForFunction(() => window.sinew.tally.frames > 2 && window.sinew.tally.draws > 1);
}

/** How many pixels of the picture's middle are neither the background's colour nor near it. */
async function painted(page: Page): Promise<number> {
  return page.evaluate(() => {
    const canvas = document.getElementById("view") as HTMLCanvasElement;
    const copy = document.createElement("canvas");
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext("2d")!;
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    const off = (i: number): number => [0, 1, 2].reduce((sum, k) => sum + Math.abs(data[i + k]! - data[k]!), 0);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) count += off(i) > 40 ? 1 : 0;
    return count / (data.length / 4);
  });
}

test.afterEach(() => Served.stopAll());

const tipX = (page: Page): Promise<number> => page.evaluate(() => window.sinew.outputs()[0]!);

test("the robot is seen, and moves", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  await expect(page.locator("h1")).toHaveText(/finger/i);
  expect(await painted(page)).toBeGreaterThan(0.02);
  const before = await page.screenshot();
  const tip = await tipX(page);
  await page.getByRole("button", { name: "Reset" }).click(); // what it does may be over by now
  await page.waitForFunction((from) => Math.abs(window.sinew.outputs()[0]! - from) > 1e-3, tip);
  expect((await page.screenshot()).equals(before)).toBe(false);
  await served.stop();
});

/** A target that stands still until it is dragged. */
const still = ["--set", "targets.tip.at={times: [0, 1], values: [[0, 0, 0.19], [0.005, 0, 0.19]]}"];

/** Goals once they stand still: what leads them settles in the scene's time, not in that of the wall. */
async function settled(page: Page): Promise<number[]> {
  for (;;) {
    const [before, time] = await page.evaluate(() => [window.sinew.goals(), window.sinew.frame().time] as const);
    await page.waitForFunction((from) => window.sinew.frame().time > from + 0.1, time);
    const after = await page.evaluate(() => window.sinew.goals());
    if (after.every((value, i) => Math.abs(value - before[i]!) < 1e-7)) return after;
  }
}

test("the target is dragged, and the tip follows", async ({ page }) => {
  const served = await Served.start("examples/reach.yaml", ...still);
  await open(page, served.address);
  const grip = await page.evaluate(() => {
    const goal = window.sinew.goals();
    return window.sinew.project(goal[0]!, goal[1]!, goal[2]!);
  });
  await page.mouse.move(grip.x, grip.y);
  await page.mouse.down();
  for (let i = 1; i <= 12; ++i) {
    await page.mouse.move(grip.x - 4 * i, grip.y + 1.5 * i);
    await page.waitForTimeout(20);
  }
  await page.mouse.up();
  const trails = await page.evaluate(() => window.sinew.trails());
  expect(trails.targets).toHaveLength(1);
  expect(trails.targets[0]!).toBeGreaterThan(5);
  expect(trails.outputs[0]!).toBeGreaterThan(5);
  // The height is free in this scene.
  await page.waitForFunction(() => {
    const [goal, tip] = [window.sinew.goals(), window.sinew.outputs()];
    return Math.hypot(goal[0]! - tip[0]!, goal[1]! - tip[1]!) < 1e-3;
  });
  const moved = await settled(page);
  const time = await page.evaluate(() => window.sinew.frame().time);
  await page.waitForFunction((from) => window.sinew.frame().time > from + 0.5, time);
  const later = await page.evaluate(() => window.sinew.goals()); // it stays, whatever the scene says
  later.forEach((value, i) => expect(value).toBeCloseTo(moved[i]!, 5));
  const away = await page.evaluate(() => {
    const goal = window.sinew.goals();
    return window.sinew.project(goal[0]!, goal[1]!, goal[2]!);
  });
  expect(Math.hypot(away.x - (grip.x - 48), away.y - (grip.y + 18))).toBeLessThan(3); // under the pointer
  await page.locator(".target button").click();
  await page.waitForFunction((at) => Math.abs(window.sinew.goals()[0]! - at) > 1e-6, moved[0]!);
  await served.stop();
});

test("a target out of reach is told, with what is in the way", async ({ page }) => {
  const served = await Served.start("examples/reach.yaml", ...still);
  await open(page, served.address);
  const grip = await page.evaluate(() => {
    const goal = window.sinew.goals();
    return window.sinew.project(goal[0]!, goal[1]!, goal[2]!);
  });
  await page.mouse.move(grip.x, grip.y);
  await page.mouse.down();
  for (let i = 1; i <= 25; ++i) {
    await page.mouse.move(grip.x + 18 * i, grip.y + 2 * i);
    await page.waitForTimeout(20);
  }
  await expect(page.locator("#status .warning")).toContainText(/force at most/, { timeout: 20_000 });
  await page.mouse.up();
  await served.stop();
});

test("a slider moves the finger", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  const slider = page.locator("[data-actuator=pull]");
  await slider.fill("0.004");
  // (The scene's own pull comes past 4 mm, too.)
  await page.waitForFunction(() => Math.abs((window.sinew.frame().mine.pull ?? 0) - 0.004) < 1e-4);
  await page.waitForFunction(() => Math.abs(window.sinew.told()[0]! - 0.004) < 1e-4);
  await page.locator(".motor .auto").click();
  await page.waitForFunction(() => Object.keys(window.sinew.frame().mine).length === 0);
  await served.stop();
});

test("the body is pulled at with the mouse", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml", "--set", "actuators.pull.displacement=0 mm");
  await open(page, served.address);
  await page.waitForTimeout(500);
  const tip = await page.evaluate(() => window.sinew.outputs());
  const at = await page.evaluate(([x, y, z]) => window.sinew.project(x! - 0.008, y!, z!), tip);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let i = 1; i <= 15; ++i) {
    await page.mouse.move(at.x, at.y + 6 * i);
    await page.waitForTimeout(20);
  }
  await page.waitForFunction((z) => window.sinew.outputs()[2]! < z - 2e-3, tip[2]!);
  await page.mouse.up();
  await page.waitForFunction((z) => Math.abs(window.sinew.outputs()[2]! - z) < 1.5e-3, tip[2]!);
  await served.stop();
});

test("pause, step, reset", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  await page.getByRole("button", { name: "Pause" }).click();
  await page.waitForFunction(() => !window.sinew.frame().playing);
  const time = await page.evaluate(() => window.sinew.frame().time);
  await page.getByRole("button", { name: "Step" }).click();
  await page.waitForFunction((before) => Math.abs(window.sinew.frame().time - before - 0.01) < 1e-9, time);
  await page.getByRole("button", { name: "Reset" }).click();
  await page.waitForFunction(() => window.sinew.frame().time === 0);
  await page.locator("#view").press(" ");
  await page.waitForFunction(() => window.sinew.frame().playing);
  await served.stop();
});

test("a recorded run scrubs", async ({ page }) => {
  const out = join(folder(), "finger");
  sinew("run", "examples/finger.yaml", "-o", out, "-q", "--set", "time.duration=0.5 s");
  const served = await Served.start(out);
  await open(page, served.address);
  expect(await page.evaluate(() => window.sinew.scene().times!.length)).toBe(51);
  const timeline = page.locator("#timeline");
  await timeline.fill("17");
  await page.waitForFunction(() => window.sinew.frame().frame === 17);
  expect(await page.evaluate(() => window.sinew.frame().time)).toBeCloseTo(0.17, 9);
  const bent = await page.evaluate(() => window.sinew.outputs());
  const trail = (): Promise<{ points: number; frame: number }> =>
    page.evaluate(() => ({ points: window.sinew.trails().outputs[0]!, frame: window.sinew.frame().frame }));
  expect((await trail()).points).toBeGreaterThan(1);
  await timeline.fill("0");
  await page.waitForFunction(() => window.sinew.frame().frame === 0);
  const { points, frame } = await trail(); // it may play on
  expect(points).toBeLessThanOrEqual(frame + 1); // what is later is forgotten
  expect(await page.evaluate(() => window.sinew.outputs())).not.toEqual(bent);
  await page.waitForFunction(() => !window.sinew.frame().playing);
  await served.stop();
});

test("it connects again when the server is back", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  await served.stop();
  await expect(page.locator("#status")).toContainText("No connection");
  const again = await Served.start("examples/finger.yaml", "--port", served.port);
  const frames = await page.evaluate(() => window.sinew.tally.frames);
  await page.waitForFunction((before) => window.sinew.tally.frames > before + 5, frames);
  await expect(page.locator("#status")).not.toContainText("No connection");
  await again.stop();
  const other = await Served.start("examples/finger.yaml", "--port", served.port, "--token", "somebodyelse012345");
  await expect(page.locator("#status")).toContainText("open the address that it printed", { timeout: 15_000 });
  await other.stop();
});

test("an exported run plays from the disk without a network", async ({ page, context }) => {
  const place = folder();
  sinew("run", "examples/finger.yaml", "-o", join(place, "out"), "-q", "--set", "time.duration=0.5 s");
  sinew("export", join(place, "out"), "-o", join(place, "finger.html"));
  await context.setOffline(true);
  const asked: string[] = [];
  page.on("request", (request) => asked.push(request.url()));
  await open(page, `file://${join(place, "finger.html")}`);
  expect(await painted(page)).toBeGreaterThan(0.02);
  await page.waitForFunction(() => window.sinew.frame().frame === 50 && !window.sinew.frame().playing);
  await page.locator("#timeline").fill("10");
  await page.waitForFunction(() => window.sinew.frame().frame === 10);
  expect(asked.filter((url) => !url.startsWith("file:") && !url.startsWith("data:") && !url.startsWith("blob:"))).toEqual([]);
});

test("plots follow, and are saved", async ({ page }) => {
  const served = await Served.start("examples/reach.yaml");
  await open(page, served.address);
  await page.locator("#view").press("g");
  await expect(page.locator("#plots canvas")).toHaveCount(2);
  await page.waitForFunction(() => window.sinew.csv().split("\n").length > 20);
  const csv = await page.evaluate(() => window.sinew.csv());
  const rows = csv.trim().split("\n");
  expect(rows[0]).toContain("pull_right.force");
  const times = rows.slice(1).map((row) => Number(row.split(",")[0]));
  expect(times.every((time, i) => i === 0 || time > times[i - 1]!)).toBe(true);
  await served.stop();
});

/** What the legend says, a row for each kind. */
async function legend(page: Page): Promise<string[]> {
  return page.locator("#legend span").allTextContents();
}

test("an exported run has every quantity, each under its own name", async ({ page }) => {
  const place = folder();
  sinew("run", "examples/finger.yaml", "-o", join(place, "out"), "-q", "--set", "time.duration=0.5 s");
  sinew("export", join(place, "out"), "-o", join(place, "finger.html"));
  await open(page, `file://${join(place, "finger.html")}`);
  await page.waitForFunction(() => window.sinew.frame().frame === 50 && !window.sinew.frame().playing);
  for (const [name, unit] of [["von_mises", /kPa$/], ["volume_ratio", /^(0\.9|1\.0)/]] as const) {
    await page.getByLabel("Solids").selectOption(name);
    await expect(page.locator("#legend span").nth(1)).toHaveText(unit);
  }
  await page.getByLabel("Rods").selectOption("bending");
  await expect(page.locator("#legend span")).toHaveCount(4);
  expect((await legend(page))[3]).toMatch(/1\/m$/);
  await page.getByLabel("Rods").selectOption("von_mises");
  await expect(page.locator("#legend span").nth(3)).toHaveText(/MPa$/);
  // Plots have the whole run, whatever of it was seen.
  const rows = (await page.evaluate(() => window.sinew.csv())).trim().split("\n");
  expect(rows.length).toBe(52);
  expect(rows[0]).toMatch(/^time \[s\],.*\[(N|m)\]/);
});

test("a rod alone has a legend of its own", async ({ page }) => {
  const served = await Served.start("examples/tendon_arm.yaml");
  await open(page, served.address);
  await page.getByLabel("Rods").selectOption("bending");
  await expect(page.locator("#legend span").first()).toHaveText("bending");
  await page.waitForFunction(() => Number.parseFloat(document.querySelectorAll("#legend span")[1]!.textContent!.split("…")[1]!) > 0.1);
  await served.stop();
});

test("two pages show what each of them chose", async ({ page, context }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  await page.getByLabel("Solids").selectOption("von_mises");
  await expect(page.locator("#legend")).toContainText("kPa");
  const other = await context.newPage();
  await open(other, served.address);
  await other.getByLabel("Solids").selectOption("volume_ratio");
  await expect(other.locator("#legend")).toContainText(/volume ratio.*(0\.9|1\.0)/);
  await page.bringToFront();
  const frames = await page.evaluate(() => window.sinew.tally.frames);
  await page.waitForFunction((before) => window.sinew.tally.frames > before + 5, frames);
  expect((await legend(page)).join(" ")).toMatch(/von Mises stress.*kPa/);
  await served.stop();
});

test("looks: section, opacity, presets, keys after a click", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml", "--set", "actuators.pull.displacement=0 mm");
  await open(page, served.address);
  await page.getByRole("button", { name: "Pause" }).click();
  await page.waitForFunction(() => !window.sinew.frame().playing);
  const seen: Buffer[] = [];
  /** What is seen is new. */
  const differs = async (): Promise<void> => {
    let own: Buffer = Buffer.alloc(0);
    await expect
      .poll(async () => {
        own = await page.locator("#view").screenshot();
        return seen.some((before) => before.equals(own));
      })
      .toBe(false);
    seen.push(own);
  };
  await differs();
  await page.getByLabel("Section", { exact: true }).fill("0.5");
  await differs();
  await page.getByLabel("cut").selectOption("from y");
  await differs();
  await page.getByLabel("Opacity").fill("1");
  await differs();
  await page.getByRole("button", { name: "Top" }).click();
  await differs();
  await page.keyboard.press("2"); // with the button still in focus
  await differs();
  const time = await page.evaluate(() => window.sinew.frame().time);
  await page.keyboard.press(".");
  await page.waitForFunction((before) => window.sinew.frame().time > before, time);
  await served.stop();
});

test("all fingers can be pulled at, beside and behind a body", async ({ page }) => {
  const served = await Served.start("examples/grasper.yaml");
  await open(page, served.address);
  const found = new Set<number>();
  for (const key of ["1", "2", "3"]) {
    await page.keyboard.press(key);
    const own = await page.evaluate(() => {
      const solids: number[] = [];
      for (let x = 280; x < innerWidth; x += 12) {
        for (let y = 20; y < innerHeight; y += 12) {
          const hit = window.sinew.pick(x, y);
          if (hit?.kind === "solid") solids.push(hit.number);
        }
      }
      return [0, 1, 2].filter((number) => solids.filter((one) => one === number).length > 20);
    });
    own.forEach((one) => found.add(one));
  }
  expect([...found].sort()).toEqual([0, 1, 2]);
  await served.stop();
});

test("a slider that is clicked at stays there", async ({ page }) => {
  const served = await Served.start("examples/tendon_arm.yaml");
  await open(page, served.address);
  const slider = page.locator("input[data-actuator]").first();
  const box = (await slider.boundingBox())!;
  await page.mouse.click(box.x + 0.3 * box.width, box.y + box.height / 2);
  const asked = Number(await slider.inputValue());
  const name = (await slider.getAttribute("data-actuator"))!;
  await page.waitForFunction((own) => own in window.sinew.frame().mine, name);
  await page.waitForTimeout(1500);
  expect(Number(await slider.inputValue())).toBe(asked);
  await page.keyboard.press("Space"); // the page's again
  await page.waitForFunction(() => !window.sinew.frame().playing);
  await served.stop();
});

test("a slider whose thumb is clicked at is held where it stands", async ({ page }) => {
  const served = await Served.start("examples/tendon_arm.yaml");
  await open(page, served.address);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => !window.sinew.frame().playing);
  const slider = page.locator("input[data-actuator]").first();
  const name = (await slider.getAttribute("data-actuator"))!;
  const box = (await slider.boundingBox())!;
  const [value, least, most] = await slider.evaluate((own: HTMLInputElement) => [own.value, own.min, own.max].map(Number));
  const thumb = box.x + 8 + ((value! - least!) / (most! - least!)) * (box.width - 16);
  await page.mouse.click(thumb, box.y + box.height / 2);
  await page.waitForFunction((own) => own in window.sinew.frame().mine, name);
  expect(Number(await slider.inputValue())).toBeCloseTo(value!, 1);
  await served.stop();
});

test("a section shows a face, not a shell", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml", "--set", "time.duration=1e6");
  await open(page, served.address);
  await page.keyboard.press("Space");
  await page.keyboard.press("2"); // from -y
  await page.getByLabel("Opacity").fill("1");
  await page.getByLabel("Solids").selectOption({ index: 0 });
  const faces = (): Promise<number> =>
    page.evaluate(() => {
      const canvas = document.getElementById("view") as HTMLCanvasElement;
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext("2d")!;
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      let count = 0; // lighter than the blue of solids, darker than the ground
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = [data[i]!, data[i + 1]!, data[i + 2]!];
        if (r > 170 && r < 235 && b - r < 40 && Math.abs(g - r) < 20) ++count;
      }
      return count;
    });
  const before = await faces();
  await page.getByLabel("Section").fill("0.5");
  await expect.poll(faces).toBeGreaterThan(before + 5000);
  await page.screenshot({ path: join(root, "viewer/test-results", "section.png") });
  await served.stop();
});

/** How many pixels in the lower left quarter of a picture have the first colour of viridis. */
function darkest(page: Page, picture: string): Promise<number> {
  return page.evaluate(async (encoded) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(encoded), (own) => own.charCodeAt(0))]));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d")!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, image.height / 2, image.width / 2, image.height / 2);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (Math.abs(data[i]! - 0x44) + Math.abs(data[i + 1]! - 0x01) + Math.abs(data[i + 2]! - 0x54) < 6) ++count;
    }
    return count;
  }, picture);
}

test("pictures and videos are saved", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  const begin = async (name: string): Promise<string> => {
    const [saved] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name, exact: true }).click()]);
    return saved.path();
  };
  const picture = readFileSync(await begin("Picture"));
  expect(picture.subarray(1, 4).toString()).toBe("PNG");
  mkdirSync(join(root, "viewer/test-results"), { recursive: true });
  writeFileSync(join(root, "viewer/test-results", "saved.png"), picture);
  expect(await darkest(page, picture.toString("base64"))).toBeGreaterThan(3); // the legend's lower end, at the left below
  await page.getByRole("button", { name: "Video" }).click();
  const draws = await page.evaluate(() => window.sinew.tally.draws);
  await page.waitForFunction((before) => window.sinew.tally.draws > before + 10, draws);
  const film = readFileSync(await begin("Stop"));
  expect(film.readUInt32BE(0)).toBe(0x1a45dfa3); // WebM
  expect(film.length).toBeGreaterThan(5000);
  await served.stop();
});

test("the token leaves the address, and the page goes on working", async ({ page, context }) => {
  const served = await Served.start("examples/finger.yaml");
  await open(page, served.address);
  const bare = `http://127.0.0.1:${served.port}/`;
  expect(page.url()).toBe(bare);
  await page.reload();
  await page.waitForFunction(() => window.sinew.tally.frames > 2);
  const second = await context.newPage();
  await open(second, bare);
  await open(second, served.address);
  expect(second.url()).toBe(bare);
  await served.stop();
  const again = await Served.start("examples/finger.yaml", "--port", served.port);
  await page.reload();
  await page.waitForFunction(() => window.sinew.tally.frames > 2);
  await again.stop();
});

test("only pages that are named may frame it", async ({ page, context }) => {
  const framed = async (...args: string[]): Promise<boolean> => {
    const served = await Served.start("examples/finger.yaml", ...args);
    const notebook = createServer((_, answer) => {
      answer.setHeader("Content-Type", "text/html");
      answer.end(`<iframe src="${served.address}" width="800" height="600"></iframe>`);
    });
    await new Promise<void>((listening) => notebook.listen(8899, "127.0.0.1", listening));
    // By another name than the page's, so that browsers hold it for another site.
    await page.goto("http://localhost:8899/");
    const inside = page.frames()[1]!;
    const seen = await inside
      .waitForFunction(() => window.sinew.tally.frames > 2, undefined, { timeout: 15_000 })
      .then(() => inside.evaluate(() => location.search.length > 0))
      .catch(() => false);
    await new Promise((closed) => notebook.close(closed));
    notebook.closeAllConnections();
    await served.stop();
    await context.clearCookies();
    return seen;
  };
  expect(await framed()).toBe(false);
  expect(await framed("--embed-in", "http://localhost:1")).toBe(false);
  expect(await framed("--embed-in", "http://localhost:8899")).toBe(true);
});

test("nobody without the token gets in", async ({ page }) => {
  const served = await Served.start("examples/finger.yaml");
  const response = await page.goto(served.address.replace(/token=.*/, "token=none"));
  expect(response!.status()).toBe(403);
  await expect(page.locator("body")).toContainText("Open the address that `sinew view` printed");
  await served.stop();
});

for (const file of readdirSync(join(root, "examples")).filter((name) => name.endsWith(".yaml"))) {
  test(`a picture of ${file}`, async ({ page }) => {
    const text = readFileSync(join(root, "examples", file), "utf8");
    const still = /^analysis: (static|modal)/m.test(text);
    const out = join(folder(), "out");
    if (still) sinew("run", `examples/${file}`, "-o", out, "-q");
    const served = await Served.start(still ? out : `examples/${file}`);
    await open(page, served.address);
    await page.waitForTimeout(3000);
    expect(await painted(page)).toBeGreaterThan(0.005);
    await page.screenshot({ path: join(root, "viewer/test-results", `${file}.png`) });
    await served.stop();
  });
}
