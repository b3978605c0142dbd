"use strict";
// The page: controls, curves and the view, around one worker that simulates.

(async () => {
  const $ = id => document.getElementById(id);
  const { data, ask } = engine;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const colours = () => dark.matches
    ? ["#56b4e9", "#e69f00", "#00c08b", "#f0e442", "#d98cbf", "#ff7f50", "#a0a0ff", "#9acd32"]
    : ["#0072b2", "#d55e00", "#009e73", "#b8860b", "#aa4499", "#332288", "#882255", "#117733"];

  const trouble = message => {
    $("trouble").textContent = message;
    $("trouble").hidden = !message;
  };

  // State --------------------------------------------------------------------------------------

  const given = data.parameters.map(p => p.value);
  const state = {
    model: data.models.length - 1, trial: 0, values: [...given], integrator: data.integrator, step: data.step,
    time: data.trials[0].start, result: null, reference: [],
  };
  const valuesFor = (model, values) => data.models[model].parameters.map(i => values[i]);
  const request = () => ({
    model: state.model, trial: state.trial, values: valuesFor(state.model, state.values),
    integrator: data.integrators.findIndex(i => i.name === state.integrator), step: state.step, time: state.time,
  });

  // While a slider moves, a simulation that takes long is replaced by a draft: vi with longer steps, so that the limb
  // follows the hand. What was asked for is simulated once the slider rests.
  const drafts = { longer: 80, rest: 250 };  // than a simulation may take, after a slider has moved [ms]
  const steps = [...new Set([0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, data.step])].sort((a, b) => a - b);
  let draftStep = steps.indexOf(0.02);  // which of the steps
  let lastMilliseconds = 0;             // of a simulation that was no draft
  const shortestDraft = () => state.integrator === "vi" ? steps.indexOf(state.step) + 1 : 0;
  const isSlow = () => lastMilliseconds > drafts.longer && shortestDraft() < steps.length;
  function draft() {
    draftStep = Math.max(draftStep, shortestDraft());
    return { ...request(), integrator: data.integrators.findIndex(i => i.name === "vi"), step: steps[draftStep], isDraft: true };
  }
  function tuneDrafts(milliseconds) {
    if (milliseconds > drafts.longer && draftStep < steps.length - 1) ++draftStep;
    if (milliseconds < drafts.longer / 3 && draftStep > shortestDraft()) --draftStep;
  }

  function take(result, asked) {
    state.result = { ...result, asked };
    if (asked.isDraft) tuneDrafts(result.milliseconds);
    else lastMilliseconds = result.milliseconds;
    trouble(result.why);
    show();
  }

  // One simulation at a time; what changes meanwhile is simulated next.
  let isRunning = false, isWanted = false, isMoving = false, resting = 0;
  const simulated = [];  // who waits for the next result that is no draft
  async function simulate(moves = false) {
    clearTimeout(resting);
    isWanted = true;
    isMoving = moves;
    if (isRunning) return;
    isRunning = true;
    let asked;
    while (isWanted) {
      isWanted = false;
      asked = isMoving && isSlow() ? draft() : request();
      try {
        take(await ask("run", asked), asked);
      } catch (error) {
        trouble(error.message);
      }
    }
    isRunning = false;
    if (asked.isDraft) resting = setTimeout(simulate, drafts.rest);
    else simulated.splice(0).forEach(resolve => resolve(state.result));
  }
  // What is shown is not saved while it is a draft.
  async function saveWhatWasAsked(save) {
    if (state.result.asked.isDraft) await new Promise(resolve => { simulated.push(resolve); simulate(); });
    if (!state.result.asked.isDraft) save();
  }

  const view = new View($("view"));
  const curves = new Curves(data, colours);
  const sliders = new Sliders(data, $("sliders"), (index, value) => setValue(index, value));
  const ellipse = data.covariance ? new Ellipse(data, setValue) : null;
  $("ellipses").hidden = !ellipse;

  function setValue(index, value) {
    if (value === state.values[index]) return;
    state.values[index] = value;
    sliders.show(state.values);
    if (ellipse) ellipse.show(state.values);
    showCommand();
    simulate(true);
  }

  function largestActivation() {
    let largest = 0;
    for (const x of state.result.activations) if (x > largest) largest = x;
    return Math.max(0.05, Math.ceil(20 * largest) / 20);
  }

  function show() {
    const { names, shapes, drawing } = state.result;
    view.setShapes(shapes, names.bodies.length);
    const largest = largestActivation();
    $("largest").textContent = largest.toFixed(2);
    view.setDrawing(drawing, largest);
    curves.show(state);
  }

  function showCommand() {
    const { models, trials } = data;
    const quoted = text => /^[\w./:=@%+,-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;
    const model = models[state.model];
    let text = `fisherhill replay ${quoted(model.file)} ${quoted(trials[state.trial].files[state.model])}${data.options}`;
    text += ` --integrator ${state.integrator} --step ${state.step}`;
    // what was set beside the file of the model as given is set again
    const set = new Map(state.model === 0 ? Object.entries(data.set) : []);
    for (const i of model.parameters) {
      const name = data.parameters[i].name;
      if (state.values[i] !== given[i] || set.has(name)) set.set(name, state.values[i]);
    }
    for (const [name, value] of set) text += ` --set ${quoted(`${name}=${value}`)}`;
    $("command").textContent = text;
  }

  // Controls -----------------------------------------------------------------------------------

  const addOptions = (select, list, chosen) => list.forEach(([value, label]) => {
    const option = new Option(label, value, false, value === chosen);
    select.add(option);
  });
  addOptions($("trial"), data.trials.map((t, i) => [String(i), t.name]), "0");
  $("trialChoice").hidden = data.trials.length < 2;
  addOptions($("integrator"), data.integrators.map(i => [i.name, i.label]), data.integrator);
  addOptions($("step"), steps.map(s => [String(s), `${s} s`]), String(data.step));
  if (data.models.filter(model => model.isShown).length > 1) {
    data.models.forEach((model, i) => {
      if (!model.isShown) return;
      const label = document.createElement("label"), radio = document.createElement("input");
      radio.type = "radio";
      radio.name = "variant";
      radio.checked = i === state.model;
      radio.onchange = () => { state.model = i; sliders.enable(model.parameters); showCommand(); simulate(); };
      label.append(radio, " ", model.label);
      $("variants").append(label);
    });
  }
  const channels = curves.channels(data.trials[0]);
  addOptions($("channel"), channels.map((c, i) => [String(i), c.label]), "0");
  $("channel").onchange = () => { curves.channel = Number($("channel").value); curves.show(state, true); };
  $("inputs").onchange = () => { curves.inputs = $("inputs").value; curves.show(state, true); };
  $("trial").onchange = () => {
    state.trial = Number($("trial").value);
    const trial = data.trials[state.trial];
    state.time = trial.start;
    $("channel").replaceChildren();
    addOptions($("channel"), curves.channels(trial).map((c, i) => [String(i), c.label]), "0");
    curves.channel = 0;
    setTimeRange();
    showCommand();
    reference().then(simulate);
  };
  $("integrator").onchange = () => { state.integrator = $("integrator").value; showCommand(); simulate(); };
  $("step").onchange = () => { state.step = Number($("step").value); showCommand(); simulate(); };
  $("reset").onclick = () => {
    state.values = [...given];
    sliders.show(state.values);
    if (ellipse) ellipse.show(state.values);
    showCommand();
    simulate();
  };
  $("camera").onchange = () => { view.lookFrom($("camera").value); view.render(); };
  $("wraps").onchange = () => view.showWraps($("wraps").checked);

  // Time ---------------------------------------------------------------------------------------

  function setTimeRange() {
    const { start, end } = data.trials[state.trial];
    player.setSpan(start, end);
  }
  let isDrawing = false;
  async function showTime(time) {
    state.time = time;
    curves.setTime(time);
    if (!state.result || isDrawing || isRunning) return;
    isDrawing = true;
    try {
      const { drawing } = await ask("draw", { model: state.result.asked.model, time });
      view.setDrawing(drawing, largestActivation());
    } catch (error) {
      trouble(error.message);
    }
    isDrawing = false;
  }
  const player = new Player({ button: $("play"), range: $("time"), clock: $("clock"), speed: $("speed") }, showTime);
  document.addEventListener("keydown", event => {
    if (event.code !== "Space" || /INPUT|SELECT|BUTTON/.test(event.target.tagName)) return;
    event.preventDefault();
    $("play").click();
  });

  // Results ------------------------------------------------------------------------------------

  function save(name, url) {
    const link = document.createElement("a");
    link.download = name;
    link.href = url;
    link.click();
  }
  const saveText = (name, text, type) => save(name, URL.createObjectURL(new Blob([text], { type })));
  $("png").onclick = () => saveWhatWasAsked(() => { view.render(); save("limb.png", $("view").toDataURL("image/png")); });
  $("svg").onclick = () => saveWhatWasAsked(() => saveText("motion.svg", curves.svg(), "image/svg+xml"));
  $("csv").onclick = () => saveWhatWasAsked(() => saveText("motion.csv", curves.csv(state), "text/csv"));
  $("copy").onclick = () => navigator.clipboard.writeText($("command").textContent);

  // Begin --------------------------------------------------------------------------------------

  // The motion of the first model as it was given, for comparison.
  async function reference() {
    state.reference = await ask("run", { ...request(), model: 0, values: data.models[0].values });
  }
  drawColours(document.querySelector("#colours canvas"));
  const fitSizes = () => { view.resize(); if (state.result) curves.show(state, true); };
  window.addEventListener("resize", fitSizes);
  dark.addEventListener("change", fitSizes);
  view.resize();
  sliders.show(state.values);
  sliders.enable(data.models[state.model].parameters);
  showCommand();
  $("fit").textContent = "Compiling the model …";
  try {
    state.reference = await engine.reference;
    setTimeRange();
    // the first model's values are those given
    if (state.model === 0) take(state.reference, request());
    else await simulate();
    if (ellipse) ellipse.show(state.values);
    performance.mark("first picture");
    document.body.dataset.ready = "yes";
  } catch (error) {
    trouble(error.message);
    document.body.dataset.ready = "no";
  }

  // For scripts and tests: sets values by name and waits for what is simulated with them.
  window.explore = {
    state, view, drafts,
    set(values) {
      for (const [name, value] of Object.entries(values))
        state.values[data.parameters.findIndex(p => p.name === name)] = value;
      sliders.show(state.values);
      showCommand();
      return new Promise(resolve => { simulated.push(resolve); simulate(); });
    },
  };
})();
