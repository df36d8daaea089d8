import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One file, with nothing to be fetched: what the program carries and `sinew export` writes.
export default defineConfig({
  plugins: [viteSingleFile()],
  build: { outDir: "dist", target: "es2022", reportCompressedSize: false, cssMinify: true },
});
