// How long a picture takes: figures for bench/README.md, not tests. scripts/test_page --figures runs them.

import { test } from "@playwright/test";

import { Served } from "./server";
import type { Window as Own } from "./window";

declare const window: Own;

test.afterEach(() => Served.stopAll());

for (const [file, seconds] of [["reach", 10], ["finger", 10], ["grasper", 10]] as const) {
  test(`pictures of ${file}`, async ({ page }) => {
    const served = await Served.start(`examples/${file}.yaml`);
    await page.goto(served.address);
    await page.waitForFunction(() => window.sinew.tally.draws > 20);
    const begin = await page.evaluate(() => ({ ...window.sinew.tally }));
    await page.waitForTimeout(1000 * seconds);
    const { tally, head } = await page.evaluate(() => ({ tally: { ...window.sinew.tally }, head: window.sinew.frame() }));
    const rate = (name: "frames" | "draws"): string => ((tally[name] - begin[name]) / seconds).toFixed(0);
    console.log(
      `${file}: ${rate("frames")} frames and ${rate("draws")} pictures a second; script ${tally.scriptMs.toFixed(2)} ms ` +
        `(worst ${tally.worstMs.toFixed(1)}), drawing ${tally.drawMs.toFixed(2)} ms, ` +
        `server ${head.frame_ms.toFixed(3)} ms a frame, step ${head.step_ms.toFixed(2)} ms`,
    );
    await served.stop();
  });
}
