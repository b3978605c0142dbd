"use strict";
// The worker that simulates. It is started before the libraries are read, so that it compiles the models meanwhile.

const engine = (() => {
  const text = id => document.getElementById(id).textContent;
  const data = JSON.parse(text("data"));
  const worker = new Worker(URL.createObjectURL(new Blob([text("worker")], { type: "text/javascript" })));
  const waiting = new Map();
  let lastId = 0;
  worker.onmessage = ({ data: { id, answer, failure } }) => {
    const { resolve, reject } = waiting.get(id);
    waiting.delete(id);
    if (failure === undefined) resolve(answer);
    else reject(new Error(failure));
  };
  const ask = (what, more) => new Promise((resolve, reject) => {
    waiting.set(++lastId, { resolve, reject });
    worker.postMessage({ id: lastId, what, ...more });
  });

  // The motion of the first model as it was given.
  const first = {
    model: 0, trial: 0, values: data.models[0].values,
    integrator: data.integrators.findIndex(i => i.name === data.integrator), step: data.step, time: data.trials[0].start,
  };
  const reference = ask("load", { core: text("core"), setups: data.models.map(model => ({ ...model.setup, files: { ...data.files } })) })
    .then(() => ask("run", first));
  reference.catch(() => {});  // whoever awaits it tells why it failed
  return { data, ask, reference };
})();
