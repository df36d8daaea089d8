import { defineConfig } from "@playwright/test";

// The pages are drawn by software: a machine of a CI has no better.
export default defineConfig({
  testDir: "tests",
  timeout: 120_000,
  workers: 1,
  reporter: [["list"]],
  projects: [
    { name: "tests", testIgnore: "figures.spec.ts" },
    { name: "figures", testMatch: "figures.spec.ts" },
  ],
  use: {
    viewport: { width: 1200, height: 760 },
    launchOptions: {
      executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    },
  },
});
