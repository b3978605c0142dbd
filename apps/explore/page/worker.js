"use strict";
// Simulates beside the page, so that it stays responsive. Behind core.js in one script.

let cores = [];

async function load({ wasm, setups }) {
  const started = performance.now();
  cores = [];
  for (const setup of setups) {
    const core = await Core.from(wasm);
    core.load(setup);
    cores.push(core);
  }
  return { milliseconds: performance.now() - started };
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
