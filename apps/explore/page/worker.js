"use strict";
// Simulates beside the page, so that it stays responsive. Behind core.js in one script.

let cores = [];

async function unpacked(base64) {
  const text = atob(base64), packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// @param core  the .wasm, packed by gzip, in base 64
async function load({ core, setups }) {
  const wasm = await unpacked(core);
  cores = [];
  for (const setup of setups) {
    const loaded = await Core.from(wasm);
    loaded.load(setup);
    cores.push(loaded);
  }
}

function run({ model, trial, values, integrator, step, time }) {
  const core = cores[model];
  const started = performance.now();
  const why = core.run(trial, values, integrator, step);
  const milliseconds = performance.now() - started;
  return {
    why, milliseconds,
    times: core.series("times"), coordinates: core.series("coordinates"),
    activations: core.series("activations"), excitations: core.series("excitations"),
    measured: core.series("measured"),
    names: { coordinates: core.names("coordinates"), muscles: core.names("muscles"),
             bodies: core.names("bodies"), paths: core.names("paths") },
    shapes: core.shapes(), drawing: core.drawing(time),
  };
}

const answers = {
  load, run,
  draw: ({ model, time }) => ({ drawing: cores[model].drawing(time) }),
};

self.onmessage = async ({ data }) => {
  try {
    self.postMessage({ id: data.id, answer: await answers[data.what](data) });
  } catch (error) {
    self.postMessage({ id: data.id, failure: error.message || String(error) });
  }
};
