"use strict";
// The simulation core (webassembly/live_exports.cc) as an object; in the page's worker, and in tests.

const Role = { free: 0, locked: 1, prescribed: 2, held: 3, cylinder: 4, starts: 5, ignoreExtra: 6 };
const Series = { times: 0, coordinates: 1, activations: 2, excitations: 3, measured: 4 };
const Names = { coordinates: 0, muscles: 1, bodies: 2, paths: 3 };

class Core {
  /// @param bytes  of the .wasm
  static async from(bytes) {
    const core = new Core();
    const nothing = () => 0;
    const { instance } = await WebAssembly.instantiate(bytes, {
      env: { emscripten_notify_memory_growth: nothing },
      wasi_snapshot_preview1: {
        clock_time_get: (id, precision, out) => {
          const now = BigInt(Math.round(performance.now() * 1e6));
          new DataView(core.c.memory.buffer).setBigUint64(out, now, true);
          return 0;
        },
        environ_sizes_get: (count, size) => {
          const view = new DataView(core.c.memory.buffer);
          view.setUint32(count, 0, true);
          view.setUint32(size, 0, true);
          return 0;
        },
        environ_get: nothing,
        proc_exit: () => { throw new Error("the simulation core has ended"); },
      },
    });
    core.c = instance.exports;
    core.c._initialize();
    return core;
  }

  // Calls function(address, length, …) with each text as UTF-8.
  withTexts(texts, call) {
    const held = texts.map(text => {
      const bytes = new TextEncoder().encode(text);
      const at = this.c.live_allocate(Math.max(bytes.length, 1));
      new Uint8Array(this.c.memory.buffer).set(bytes, at);
      return [at, bytes.length];
    });
    try {
      return call(...held.flat());
    } finally {
      held.forEach(([at]) => this.c.live_free(at));
    }
  }

  textAt(address) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    let end = address;
    while (bytes[end]) ++end;
    return new TextDecoder().decode(bytes.slice(address, end));
  }

  check(address) {
    const message = this.textAt(address);
    if (message) throw new Error(message);
  }

  numbers() {
    return new Float64Array(this.c.memory.buffer, this.c.live_numbers(), this.c.live_count()).slice();
  }

  file(name, text) {
    this.withTexts([name, text], (...at) => this.c.live_file(...at));
  }

  /// @param setup  {model, trials: [{file, sha256}], files: {name: text}, choice: [[role, name, value]],
  ///   prescribedBySystem: [name], parameters: [name]}
  load(setup) {
    for (const [name, text] of Object.entries(setup.files)) this.file(name, text);
    for (const [role, name, value] of setup.choice)
      this.withTexts([name], (...at) => this.c.live_choose(Role[role], ...at, value));
    for (const name of setup.prescribedBySystem)
      this.withTexts([name], (...at) => this.c.live_prescribe(...at));
    this.withTexts([setup.model], (...at) => this.check(this.c.live_load(...at)));
    for (const trial of setup.trials)
      this.withTexts([trial.file, trial.sha256], (...at) => this.check(this.c.live_add_trial(...at)));
    const names = setup.parameters.map(name => name + "\n").join("");
    this.withTexts([names], (...at) => this.check(this.c.live_select(...at)));
    this.count = setup.parameters.length;
    this.values = this.c.live_allocate(8 * Math.max(this.count, 1));
  }

  /// @returns why the motion ended early; empty if it did not
  run(trial, values, integrator, step) {
    new Float64Array(this.c.memory.buffer, this.values, this.count).set(values);
    this.check(this.c.live_run(trial, this.values, this.count, integrator, step));
    return this.textAt(this.c.live_why());
  }

  names(what) {
    return this.textAt(this.c.live_names(Names[what])).split("\n").slice(0, -1);
  }

  series(what) {
    this.check(this.c.live_series(Series[what]));
    return this.numbers();
  }

  drawing(time) {
    this.check(this.c.live_drawing(time));
    return this.numbers();
  }

  shapes() {
    this.check(this.c.live_shapes());
    return this.numbers();
  }
}

if (typeof module === "object") module.exports = { Core };
