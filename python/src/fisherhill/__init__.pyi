"""Hill muscles and Fisher information: simulate, identify and explain how muscles move limbs.

Everything is in SI units and radians; arrays have one row per time. A file is named by a str or a
path of pathlib. A table of columns is a dict of sequences or arrays of numbers, or a DataFrame of
pandas, whose index is not read.

Errors: values and files that break a rule raise ValueError, and a computation that cannot be
carried out raises RuntimeError, each with one line that says which quantity and which rule. An
argument of a wrong type or name raises TypeError. Long computations can be interrupted by Ctrl-C
(KeyboardInterrupt), and other threads run meanwhile.

What functions return is a types.SimpleNamespace; its members are those of the classes below that
are marked `type_check_only`, which exist for type checkers alone. Those that are tables have
to_dataframe() (pandas) and show themselves in notebooks, many of them also have plot()
(matplotlib); lists of results are tables as well.
"""

# The docstrings of the compiled module are made from this file (python/docstrings.py).

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Protocol, TypeAlias, TypeVar, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Model",
    "System",
    "Trial",
    "calibrate",
    "compare",
    "compare_muscles",
    "compare_robot_estimators",
    "cost_gradient",
    "cramer_rao_bound",
    "design",
    "design_on_dynamometer",
    "discover",
    "discover_robot",
    "emg",
    "ensemble",
    "estimate",
    "estimate_string_length",
    "explore",
    "fisher_information",
    "fit_paths",
    "global_sensitivity",
    "identifiability",
    "length_jumps",
    "list_effects",
    "list_parameters",
    "load_model",
    "load_trial",
    "make_trial",
    "moment_arms",
    "muscle_states",
    "opensim_differences",
    "optimise_robot_motion",
    "parameter_sweep",
    "predict",
    "profile_likelihood",
    "read_recording",
    "read_study",
    "replay",
    "robot_information",
    "sensitivity",
    "separate",
    "study",
    "write_emg_config",
]

__version__: str

_Array: TypeAlias = NDArray[np.float64]
_Integrator: TypeAlias = Literal["vi", "vi-left", "vi-adaptive", "rk4", "cvode"]
_File: TypeAlias = str | PathLike[str]

@type_check_only
class _DataFrame(Protocol):  # of pandas, and what is like it
    columns: Any
    to_numpy: Any

_Columns: TypeAlias = Mapping[str, ArrayLike] | _DataFrame
_Progress: TypeAlias = bool | Callable[[float], object]

# Tables -------------------------------------------------------------------------------------------

_Row = TypeVar("_Row")

@type_check_only
class _Table:
    def to_dataframe(self) -> Any:
        """The result as a DataFrame of pandas, its rows named by the first column.

        Raises
        ------
        ImportError
            Without pandas (apt-get install python3-pandas).
        """

    def _repr_html_(self) -> str:
        """The first rows as HTML, for notebooks."""

@type_check_only
class _Plotted(_Table):
    def plot(self, axes: Any = None) -> Any:
        """Draws what the result is about.

        Parameters
        ----------
        axes : matplotlib axes, or a list of them where there are several panels
            Default: of a new figure.

        Returns
        -------
        The axes.

        Raises
        ------
        ImportError
            Without matplotlib (apt-get install python3-matplotlib).
        """

@type_check_only
class _Rows(list[_Row], _Table): ...

@type_check_only
class _PlottedRows(list[_Row], _Plotted): ...

# Models and trials --------------------------------------------------------------------------------

@type_check_only
class Remark:
    weight: Literal["error", "warning", "unusual"]
    subject: str
    message: str

class Model:
    """A musculoskeletal model, read from a file as by load_model, or made by calibrate or discover.

    Parameters
    ----------
    file : str or PathLike
        An OpenSim 3 or 4 model (.osim), a URDF or an MJCF.

    Raises
    ------
    ValueError
        If the file cannot be read, is not a model, or breaks a rule; the line names file and element.
    """

    def __init__(self, file: _File) -> None: ...
    @property
    def name(self) -> str:
        """Name of the model."""

    @property
    def coordinates(self) -> list[str]:
        """Names of all coordinates."""

    @property
    def muscles(self) -> list[str]:
        """Names of the enabled muscles."""

    @property
    def warnings(self) -> list[str]:
        """What the file contains but is not simulated, one line each."""

    @property
    def remarks(self) -> list[str]:
        """What the file contains but is interpreted differently, one line each."""

    def review(self) -> _Rows[Remark]:
        """Unusual numbers of the model, as check lists them beside warnings and remarks.

        Returns
        -------
        list
            Each with

            weight : str
                'error' (simulations refuse it), 'warning' (probably a mistake, as another unit) or 'unusual'.
            subject : str
                What it is about, e.g. "coordinate 'elbow_flexion'".
            message : str
                Quantity, value with its unit, and the usual range.
        """

    def write(self, file: _File) -> None:
        """Writes the model as an OpenSim 4 file (.osim).

        Parameters
        ----------
        file : str or PathLike
            The file appears complete or not at all.

        Raises
        ------
        ValueError
            If the file cannot be written, or a muscle is not a Schutte muscle.
        """

    def with_muscles(self, muscle_class: str) -> Model:
        """The model with all muscles of one class, as --convert-muscles makes it.

        Parameters
        ----------
        muscle_class : str
            'Thelen2003', 'Millard2012', 'DeGrooteFregly2016', 'Schutte1993', 'RigidTendon' (Millard2012
            with a rigid tendon) or 'RigidTendonMuscle'.

        Returns
        -------
        Model
            Numbers that the class does not have are named in its warnings.

        Raises
        ------
        ValueError
            For another class, or a muscle whose numbers break a rule of it.
        """

    def with_cylinders(self, names: Sequence[str]) -> Model:
        """The model with wrap cylinders in place of ellipsoids, as --wrap-as-cylinder takes them.

        Parameters
        ----------
        names : list of str
            Wrap ellipsoids with two equal semi-axes, which are the radius; the third is the axis and
            half the length. Objects of another shape, and spheres, stay as they are.

        Returns
        -------
        Model
            With a remark on each. The cylinder's axis is z of its frame, to which its parameters
            rotation.x to rotation.z refer. Files that it is written to have cylinders, too.

        Raises
        ------
        ValueError
            For an unknown name, or an ellipsoid without two equal semi-axes.
        """

    def with_parameters(
        self,
        values: Mapping[str, float] | None = None,
        *,
        coordinate: str | Sequence[str] = [],
        lock: dict[str, float] = {},
        **named: float,
    ) -> Model:
        """The model with other values of some of its parameters, as --set of the program takes them.

        What is estimated with it starts at these values and has the means of its priors there. The
        model itself stays as it is.

        Parameters
        ----------
        values : mapping
            {name: value} in SI units and radians, as {'TRI.radius': 0.018}. Names are those that
            list_parameters lists; a name may also be an argument of its own, as in
            with_parameters(**{'TRI.radius': 0.018}).
        coordinate, lock
            As in replay; only muscles that move a free coordinate have parameters. Without a
            coordinate all are free that the model does not lock.

        Returns
        -------
        Model

        Raises
        ------
        ValueError
            For an unknown name, with the nearest ones; one given twice, or two that set the same
            number; a value that breaks a rule; emg.… and initial.…, which belong to a trial.
        TypeError
            For a value that is not a number.

        Examples
        --------
        >>> model = fisherhill.load_model("models/elbow8.osim")
        >>> thicker = model.with_parameters({"TRI.radius": 0.018})
        >>> [one.value for one in fisherhill.list_parameters(thicker) if one.name == "TRI.radius"]
        [0.018]
        """

    def with_external_loads(self, file: _File) -> Model:
        """The model with forces and torques on bodies, which replay, comparisons and ensemble simulate.

        Parameters
        ----------
        file : str or PathLike
            OpenSim's ExternalLoads (.xml); its datafile must cover the trials. They are not written
            into a model file.

        Returns
        -------
        Model

        Raises
        ------
        ValueError
            If the file cannot be read or breaks a rule; the line names file and line.
        """

class Trial:
    """Excitations, measured coordinates and loads of one recording, made by load_trial or make_trial."""

    @property
    def name(self) -> str:
        """Name of the file, or the name given to make_trial."""

    @property
    def times(self) -> _Array:
        """Times [s]."""

    @property
    def muscles(self) -> list[str]:
        """Names of the columns of `excitations`: the enabled muscles of the model, in its order, then
        those switched off that have a column."""

    @property
    def excitations(self) -> _Array:
        """Excitations, 0 to 1; times x muscles."""

    @property
    def measured(self) -> dict[str, tuple[_Array, _Array]]:
        """{coordinate: (times [s], values [rad] or [m])}, without the times at which it was not measured."""

    @property
    def prescribed(self) -> dict[str, tuple[_Array, _Array]]:
        """The same of the coordinates whose motion is given; one that is held has one value."""

    @property
    def channels(self) -> dict[str, tuple[_Array, _Array]]:
        """{column: (times [s], values)} of all else that was measured, e.g. 'elbow_flexion.moment' [N m],
        'BRA.fiber_length' [m]."""

    @property
    def known_mass_in_hand(self) -> float:
        """Mass held by design [kg]; only discover and replay take it into account."""

    @property
    def known_arm_turn(self) -> float:
        """Angle by which the whole limb was turned [rad]; only discover and replay take it into account."""

    @property
    def warnings(self) -> list[str]:
        """Remarks on the columns, one line each."""

    def columns(self, model: Model) -> dict[str, _Array]:
        """The trial as columns by name, as make_trial takes them.

        Parameters
        ----------
        model : Model
            The one that the trial was read for.

        Returns
        -------
        dict
            {column: values}, each as long as `times`, in SI units and radians, NaN where it was not
            measured. Prescribed motions are among them, values at which a coordinate is held are not.

        Examples
        --------
        >>> model = fisherhill.load_model("models/elbow8.osim")
        >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
        >>> columns = trial.columns(model)
        >>> list(columns)[:2], list(columns)[-1], len(columns["BRA"])
        (['time', 'TRIlong'], 'elbow_flexion', 901)
        >>> again = fisherhill.make_trial(model, columns | {"BRA": np.full(901, 0.1)})
        """

    def with_excitations(self, excitations: ArrayLike) -> Trial:
        """A copy of the recording with other excitations.

        Parameters
        ----------
        excitations : array, times x muscles
            0 to 1, the columns as in `muscles`.

        Returns
        -------
        Trial
            A start that a model was fitted with for this trial holds for it as well; for the functions
            that take several trials both are one and the same.

        Raises
        ------
        ValueError
            For another shape, or a value that is not 0 to 1; the line names muscle and time.
        """

    def review(self, model: Model) -> _Rows[Remark]:
        """Unusual numbers of the trial, as check lists them beside warnings.

        Parameters
        ----------
        model : Model
            The one that the trial was read for; ranges of coordinates are its ranges.

        Returns
        -------
        list
            As of Model.review.
        """

def load_model(file: _File) -> Model:
    """Reads an OpenSim 3 or 4 model (.osim), a URDF or an MJCF.

    Parameters
    ----------
    file : str or PathLike

    Returns
    -------
    Model

    Raises
    ------
    ValueError
        If the file cannot be read, is not a model, or breaks a rule; the line names file and element.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> model
    <fisherhill.Model 'elbow8', 8 muscles>
    >>> "elbow_flexion" in model.coordinates
    True
    """

def load_trial(
    file: _File,
    model: Model,
    *,
    ignore_extra: bool = False,
    prescribe: Sequence[str] = [],
    hold: dict[str, float] = {},
    prescribe_cutoff: float | None = None,
) -> Trial:
    """Reads a trial of the model (.sto, .mot or .csv).

    Header lines known_mass_in_hand_kg=1 and known_arm_turn_deg=-45 state the experimental conditions.

    Parameters
    ----------
    file : str or PathLike
    model : Model
    ignore_extra : bool
        True: ignore columns that match nothing in the model, with a warning.
    prescribe : list of str
        Coordinates that move as their columns say, as on a dynamometer, in all functions that take
        the trial. Those that the model prescribes move on its functions of time without this, unless
        they are named free or locked.
    hold : dict
        {coordinate: value [rad] or [m]} at which a device holds it, so that its moment is known.
    prescribe_cutoff : float, optional
        Smooth the prescribed motions, so that a sine of this frequency [Hz] > 0 is halved. Default:
        not smoothed.

    Returns
    -------
    Trial

    Raises
    ------
    ValueError
        If the file cannot be read or breaks a rule; the line names file, column and row.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> trial.muscles[:3]
    ['TRIlong', 'TRIlat', 'TRImed']
    >>> times, angle = trial.measured["elbow_flexion"]
    """

def make_trial(
    model: Model,
    columns: _Columns,
    *,
    name: str = "trial",
    ignore_extra: bool = False,
    known_mass_in_hand: float = 0.0,
    known_arm_turn: float = 0.0,
    prescribe: Sequence[str] = [],
    hold: dict[str, float] = {},
    prescribe_cutoff: float | None = None,
    latent_excitation: str = "",
) -> Trial:
    """Makes a trial from arrays.

    Parameters
    ----------
    model : Model
    columns : dict or DataFrame
        {column: values}, named as in a file, all of one length: 'time' [s]; muscles (excitation, 0 to
        1); 'elbow_flexion' [rad] or 'elbow_flexion_deg', NaN where it was not measured;
        'elbow_flexion.torque' [N m], an external load; 'elbow_flexion.moment' [N m], what the limb
        exerts on a device there; 'BRA.fiber_length' [m], 'BRA.pennation' [rad] and others that a
        file may have.
    name : str
        Name of the trial in messages.
    ignore_extra : bool
        True: ignore columns that match nothing in the model, with a warning.
    known_mass_in_hand : float
        Mass that the subject held by design [kg].
    known_arm_turn : float
        Angle by which the whole limb was turned against the ground [rad], positive as the coordinate
        rises.
    prescribe, hold, prescribe_cutoff
        As in load_trial.
    latent_excitation : str
        What a file's header line of that name says, 'MUSCLE SD SECONDS', several between semicolons:
        muscles without an electrode, whose excitations calibrate corrects; empty: none.

    Returns
    -------
    Trial

    Raises
    ------
    ValueError
        If columns differ in length or break a rule of a file's columns.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> times = np.linspace(0, 1, 11)
    >>> held = fisherhill.make_trial(model, {"time": times, "BRA": np.full(11, 0.2)}, ignore_extra=True)
    >>> held.excitations.shape
    (11, 8)
    """

# Recordings ---------------------------------------------------------------------------------------

@type_check_only
class EmgElectrode:
    unit: str
    rate: float
    start_time: float
    filtered: _Array
    envelope: _Array
    full: float
    full_source: str
    fraction_below: float
    fraction_above: float
    excitation: _Array

@type_check_only
class EmgResult(_Plotted):
    columns: dict[str, _Array]
    muscles: list[str]
    electrodes: dict[str, EmgElectrode]
    fraction_of_sums_clipped: float
    offsets: dict[str, float]
    latent_excitation: str
    remarks: list[str]
    warnings: list[str]

def emg(recordings: _File | Sequence[_File], config: _File, *, write: _File = "") -> EmgResult:
    """Converts raw EMG recordings of one movement into the columns of a trial.

    With e = emg(recordings, config), the trial is
    make_trial(model, e.columns, latent_excitation=e.latent_excitation), or load_trial of the written
    file.

    Parameters
    ----------
    recordings : str or PathLike, or list of these
        File, or several of the same movement: text columns, Trigno export, .sto, .mot, .csv, .c3d,
        .xdf or .trc.
    config : str or PathLike
        File (.toml) of channels, filters, electrodes and muscles (docs/emg.md).
    write : str or PathLike
        File (.sto) to which the trial is written, as the program writes it; empty: none.

    Returns
    -------
    columns : dict
        {column: values}, equally spaced rows: 'time' [s]; muscles (excitation, 0 to 1); the measured
        coordinate, e.g. 'elbow_flexion_deg' [deg], and other columns of the configuration, NaN where
        they were not measured.
    muscles : list of str
        The columns that are excitations.
    electrodes : dict
        {channel: electrode}, each at its own rate, with

        unit : str
            Of the signal.
        rate, start_time : float
            [Hz], [s]
        filtered, envelope : array, samples
            Before rectification (empty for envelopes), and after the low-pass [unit].
        full : float
            Envelope that corresponds to excitation 1 [unit].
        full_source : str
            Where that number comes from.
        fraction_below, fraction_above : float
            Of the samples, below 0 and above 1, which were clipped.
        excitation : array, samples
            0 to 1, not yet delayed.
    fraction_of_sums_clipped : float
        Of all excitations: weighted sums of electrodes above 1.
    offsets : dict
        {file: offset [s]} of further recordings: time of the first = its own + offset.
    latent_excitation : str
        The header line of that name of a trial's file, if calibrate may correct muscles without an
        electrode, else empty; make_trial takes it.
    remarks, warnings : list of str
        Processing steps and limitations; channels that look wrong.

    Raises
    ------
    ValueError
        If a file cannot be read, a channel is missing or has gaps, or a setting breaks a rule; the
        line names file and key, or channel.
    """

@type_check_only
class RecordedChannel:
    name: str
    unit: str
    rate: float
    start_time: float
    values: _Array

@type_check_only
class RecordedFile:
    markers: dict[str, _Array]
    times: _Array
    frame_rate: float
    channels: _Rows[RecordedChannel]
    remarks: list[str]

def read_recording(file: _File) -> RecordedFile:
    """Reads markers and signals of a recording: any file that emg reads and that names its channels.

    read_recording(file).channels.to_dataframe() lists them.

    Parameters
    ----------
    file : str or PathLike
        Text export, .sto, .mot, .csv, .c3d, .xdf, .edf, .bdf or .trc (docs/emg.md). A file of columns
        without a header needs the declarations of emg's configuration (write_emg_config).

    Returns
    -------
    markers : dict
        {marker: array, frames x 3} in the laboratory's axes [m]; NaN: not seen.
    times : array, frames
        [s]; empty without markers.
    frame_rate : float
        [Hz]; NaN for a format without markers.
    channels : list
        Analog channels, or those of all streams; names need not be unique. A table, each row with

        name, unit : str
            The unit of its values; empty: not stated in the file.
        rate, start_time : float
            [Hz], [s]: value k belongs to start_time + k / rate.
        values : array
            NaN: not measured.
    remarks : list of str
        What was left out or assumed, and markers that are never seen.

    Raises
    ------
    ValueError
        If the file cannot be read, contradicts itself, has no header or is of another format.
    """

@type_check_only
class EmgConfigDraft:
    channels: int
    electrodes: int
    is_complete: bool

def write_emg_config(recordings: _File | Sequence[_File], file: _File) -> EmgConfigDraft:
    """Writes a configuration of emg to begin with: the channels as comments, a table for every setting.

    Parameters
    ----------
    recordings : str or PathLike, or list of these
        File, or several of the same movement, as emg takes them.
    file : str or PathLike
        File (.toml) to write; one that is there is not overwritten.

    Returns
    -------
    channels, electrodes : int
        Number of channels of the recordings, and of those taken for EMG: in volts, or called EMG.
    is_complete : bool
        True: emg takes the file as it is, muscles called as their channels; False: comments say what is
        needed.

    Raises
    ------
    ValueError
        If a recording cannot be read, or the file is there already or cannot be written.
    """

# Muscles ------------------------------------------------------------------------------------------

@type_check_only
class MuscleStatesResult(_Table):
    muscle_class: list[str]
    fibre_velocity: _Array
    tendon_force: _Array
    static_fibre_length: _Array
    static_tendon_force: _Array

def muscle_states(file: _File) -> MuscleStatesResult:
    """Evaluates muscle laws for given states, class by class.

    Parameters
    ----------
    file : str or PathLike
        Table (.csv) with class, max_isometric_force [N], optimal_fiber_length [m],
        tendon_slack_length [m], pennation [rad], max_contraction_velocity [optimal lengths/s],
        activation, fiber_length [m], path_length [m] and path_speed [m/s]; models/muscle_states.csv
        is one.

    Returns
    -------
    muscle_class : list of str
        Of each row, as the file has it.
    fibre_velocity, tendon_force : array, rows
        [m/s], [N]
    static_fibre_length, static_tendon_force : array, rows
        At rest at this activation and path length [m], [N]; NaN where no length balances the tendon.

    Raises
    ------
    ValueError
        For a missing column, a cell that is no number, an unknown class or column, or a number that
        breaks a rule of the class.
    """

# Replay -------------------------------------------------------------------------------------------

@type_check_only
class ReplayResult(_Plotted):
    time: _Array
    coordinates: list[str]
    muscles: list[str]
    q: _Array
    q_dot: _Array
    activation: _Array
    fibre_length: _Array
    tendon_force: _Array
    moment_arm: _Array
    reaction: dict[str, _Array]
    rms_error: dict[str, float]
    channel_rms_error: dict[str, float]
    energy_error: float
    outcome: Literal["ok", "unstable", "no solution"]
    why: str
    left_range: str
    start_from: Literal["given", "model", "measured", "default"]
    step: float
    step_too_long: str
    steps: int
    newton_iterations: int
    warnings: list[str]

def replay(
    model: Model,
    trial: Trial,
    *,
    initial: dict[str, float] = {},
    strict: bool = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> ReplayResult:
    """Simulates the motion produced by a trial's excitations.

    Parameters
    ----------
    model : Model
    trial : Trial
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest. Default: the fitted or first measured value,
        else the model's default value.
    strict : bool
        True: RuntimeError if the motion leaves the valid range of the model (left_range).
    coordinate : str or list of str
        The free coordinate, or several. Default: the measured coordinates of the trial, else all that
        the model does not lock.
    lock : dict
        {coordinate: value [rad] or [m]} at which other coordinates are locked. Default: the model's
        default values.
    integrator : {'vi', 'vi-left', 'vi-adaptive', 'rk4', 'cvode'}
        Midpoint variational (second order), the same with forces at the left end of a step only
        (first order), 'vi' in parts of a step as short as their errors ask for, Runge-Kutta (fourth
        order), or CVODE (adaptive).
    step : float, optional
        Time step [s] > 0; of CVODE the interval of the output. Default: the one with which the model
        was fitted, else 0.01 s (rk4: 0.0002 s).

    Returns
    -------
    time : array
        [s]
    coordinates, muscles : list of str
        Names of the columns.
    q, q_dot : array, times x coordinates
        [rad] and [rad/s], or [m] and [m/s].
    activation, fibre_length, tendon_force : array, times x muscles
        0 to 1, [m], [N].
    moment_arm : array, times x muscles
        About the first free coordinate [m].
    reaction : dict
        {coordinate: values [N m] or [N]} of the prescribed and held coordinates: what keeps them on
        their course.
    rms_error : dict
        {coordinate: RMS error [rad] or [m]} of the free coordinates that were measured.
    channel_rms_error : dict
        {column: RMS error} of all else that was measured, in its unit.
    energy_error : float
        Largest energy error of the integrator [J].
    outcome : str
        'ok', 'unstable' or 'no solution'; of the last two the rows up to that time are returned.
    why : str
        The reason if the outcome is not 'ok', else empty.
    left_range : str
        When a coordinate first leaves its range by more than a tenth of it, or a fibre 0.2 to 2
        optimal lengths; empty if none does.
    start_from : str
        Source of the initial state: 'given', 'model' (fitted by discover or calibrate for this trial),
        'measured' or 'default'.
    step : float
        Time step [s].
    step_too_long : str
        What half the step changes, if a coordinate differs by more than 2 deg or 20 mm; empty if not.
        Tested where the motion has at most 20 steps, and of 'rk4' with a step that was given.
    steps, newton_iterations : int
    warnings : list of str
        About the model as it was simulated.

    Raises
    ------
    ValueError
        For an unknown coordinate or integrator, or a step that is not > 0 or longer than the trial.
    RuntimeError
        If a muscle has no static equilibrium at the start, or with strict for a motion that leaves the
        range.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> motion = fisherhill.replay(model, trial)
    >>> motion.outcome, round(float(np.degrees(motion.rms_error["elbow_flexion"])), 1)
    ('ok', 12.0)
    >>> motion.q.shape, motion.tendon_force.shape
    ((451, 1), (451, 8))
    """

# Paths --------------------------------------------------------------------------------------------

@type_check_only
class MomentArmsResult(_Table):
    muscles: list[str]
    length: _Array
    moment_arm: dict[str, _Array]
    touched: dict[str, list[list[str]]]
    notes: list[str]
    warnings: list[str]

def moment_arms(
    model: Model,
    postures: _Columns,
    *,
    lock: dict[str, float] = {},
    wrap_as_cylinder: Sequence[str] = [],
) -> MomentArmsResult:
    """Lengths and moment arms of muscles in given postures.

    Parameters
    ----------
    model : Model
    postures : dict or DataFrame
        {coordinate: values [rad] or [m]}, one for each posture, all of one length. Other coordinates
        are at their default values.
    lock : dict
        {coordinate: value [rad] or [m]} at which other coordinates are instead.
    wrap_as_cylinder : list of str
        Wrap ellipsoids with two equal semi-axes to be treated as cylinders.

    Returns
    -------
    muscles : list of str
        Names of the columns: all enabled muscles whose paths can be computed, of any class.
    length : array, postures x muscles
        Muscle-tendon lengths [m]; NaN where a path cannot be computed.
    moment_arm : dict
        {coordinate: array, postures x muscles}: r = -dL/dq [m], positive where the muscle's force tends
        to increase the coordinate.
    touched : dict
        {muscle: for each posture the wrap objects that its path touches}.
    notes, warnings : list of str
        About the paths; muscles or postures that cannot be computed.

    Raises
    ------
    ValueError
        For an unknown coordinate, columns of different lengths, or values that are not finite.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> arms = fisherhill.moment_arms(model, {"elbow_flexion": np.radians([30, 90])})
    >>> bra = arms.muscles.index("BRA")
    >>> [round(1000 * float(arm), 1) for arm in arms.moment_arm["elbow_flexion"][:, bra]]  # mm
    [12.3, 22.7]
    """

@type_check_only
class LengthJump:
    muscle: str
    coordinate: str
    value: float
    length: float
    moment_arm: float
    conditional: bool
    text: str

def length_jumps(model: Model) -> _Rows[LengthJump]:
    """Where lengths and moment arms of muscles jump, along each coordinate that is not locked or coupled.

    Other coordinates are at their default values; 720 steps over the range and 0.3 rad or m beyond.

    Parameters
    ----------
    model : Model

    Returns
    -------
    list
        Jumps of lengths by 1e-5 m or more, and of moment arms by 1e-3 m or more, each with

        muscle, coordinate : str
        value : float
            Of the coordinate [rad] or [m].
        length, moment_arm : float
            Just above it less just below it [m].
        conditional : bool
            True: a conditional point switches there; else the side of a wrap object changes.
        text : str
            The same as a sentence.
    """

@type_check_only
class OpenSimDifference:
    muscle: str
    coordinate: str
    ellipsoids: list[str]
    length: float
    length_at: float
    moment_arm: float
    moment_arm_at: float
    apart: list[tuple[float, float]]
    jumps: list[tuple[float, float]]
    text: str

def opensim_differences(model: Model) -> _Rows[OpenSimDifference]:
    """Where OpenSim's paths over ellipsoids differ from taut strings, by OpenSim's rule restated.

    Parameters
    ----------
    model : Model

    Returns
    -------
    list
        Muscles whose lengths differ by 1e-4 m or more somewhere along a coordinate, each with

        muscle, coordinate : str
        ellipsoids : list of str
            Of the path.
        length, moment_arm : float
            Largest differences, OpenSim's less the taut string's [m].
        length_at, moment_arm_at : float
            Of the coordinate there [rad] or [m].
        apart : list of tuple
            (from, to) of the coordinate, where lengths differ by 1e-4 m or more [rad] or [m].
        jumps : list of tuple
            (value of the coordinate [rad] or [m], jump of OpenSim's length [m]).
        text : str
            The same as a sentence.
    """

@type_check_only
class PathFit:
    written: bool
    why_not: str
    coordinates: list[str]
    order: int | None
    length_error: float | None
    moment_arm_error: float | None

@type_check_only
class PathFitResult:
    model: Model
    fits: dict[str, PathFit]

def fit_paths(
    model: Model,
    *,
    muscles: Sequence[str] = [],
    tolerance: float = 0.0001,
    order: int = 9,
    table: _File = "",
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    wrap_as_cylinder: Sequence[str] = [],
) -> PathFitResult:
    """Polynomials of the coordinates in place of paths (OpenSim's FunctionBasedPath).

    Parameters
    ----------
    model : Model
    muscles : list of str
        Default: all that are enabled and moved by the free coordinates.
    tolerance : float
        Largest error of a length [m] > 0; a muscle that exceeds it keeps its points.
    order : int
        Highest order tried, 1 to 9.
    table : str or PathLike
        File (.csv) of lengths to fit instead of those of the paths, OpenSim's for example, as
        moment-arms --postures writes it: columns COORDINATE [rad] or [m] and MUSCLE.length_m [m].
    coordinate, lock
        As in replay; fitted over the ranges of the free coordinates, with a table those of its columns.
    wrap_as_cylinder
        As in moment_arms; without effect on a table.

    Returns
    -------
    model : Model
        With the polynomials that are within the tolerance.
    fits : dict
        {muscle: fit}, each with

        written : bool
        why_not : str
            Why the muscle keeps its points, else empty.
        coordinates : list of str
            Of the polynomial.
        order : int or None
        length_error, moment_arm_error : float or None
            Largest errors over all postures [m].

    Raises
    ------
    ValueError
        For an unknown muscle or coordinate, a tolerance that is not > 0, another order, a coordinate
        beside a table, or a table that cannot be read.
    """

# Parameters and their information -----------------------------------------------------------------

@type_check_only
class ModelParameter:
    name: str
    value: float
    unit: str
    meaning: str
    lower: float
    upper: float
    deviation: float
    is_group: bool

def list_parameters(
    model: Model,
    *,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> _Rows[ModelParameter]:
    """Lists the parameters of the model that affect the motion.

    Parameters
    ----------
    model : Model
    coordinate, lock
        As in replay.
    integrator, step
        Without effect on the list.

    Returns
    -------
    list
        For each parameter:

        name : str
        value : float
            In the model [unit].
        unit : str
            Empty for a pure number.
        meaning : str
        lower, upper : float
            Default bounds [unit].
        deviation : float
            Default prior standard deviation [unit].
        is_group : bool
            True: it sets several parameters together and is not part of 'all'.

    Raises
    ------
    ValueError
        For an unknown coordinate.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> radius = next(one for one in fisherhill.list_parameters(model) if one.name == "TRI.radius")
    >>> radius.value, radius.unit
    (0.016, 'm')
    """

@type_check_only
class FurtherChannel:
    channel: str
    noise: float
    unit: str
    information: float
    parameter: str
    bound_before: float
    bound_after: float

@type_check_only
class SensitivityResult(_Plotted):
    names: list[str]
    units: list[str]
    values: _Array
    prior_sd: _Array
    observed: list[str]
    times: list[_Array]
    outputs: list[_Array]
    gamma: list[_Array]
    fisher: _Array
    normalised_sensitivity: _Array
    bound_alone: _Array
    bound_joint: _Array
    identifiable: list[bool]
    correlation: _Array
    determined_combinations: int
    sentences: list[str]
    further_channels: list[FurtherChannel]

def sensitivity(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    *,
    noise: float = 0.017453292519943295,
    observe: dict[str, float] = {},
    further_channels: bool = False,
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> SensitivityResult:
    """Exact sensitivities of what is measured to parameters, and the information of a measurement.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        At least one. The coordinate is taken to be measured at the times at which it was; if it was
        not, at every time step.
    parameters : list of str
        Names, which may contain *, or ['all']; list_parameters lists them.
    noise : float
        Standard deviation of the measured coordinate [rad] or [m] > 0; default: 1 degree.
    observe : dict
        {channel: standard deviation of its noise > 0} of what is measured instead of the coordinate, at
        the same times; channels are named as columns of a trial: 'elbow_flexion' [rad],
        'elbow_flexion.speed' [rad/s], 'elbow_flexion.moment' [N m] of a prescribed coordinate,
        'BRA.fiber_length' [m], 'BRA.tendon_force' [N], 'BRA.activation' (0 to 1),
        'BODY.MARKER.x' [m].
    further_channels : bool
        True: also tells what each further channel would add.
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest. Default: the fitted or first measured value,
        else the model's default value.
    coordinate : str or list of str
        The free coordinate, or several, of which the first is the measured one.
    lock, integrator, step
        As in replay, but the integrator must be variational ('vi', 'vi-left', 'vi-adaptive'), and the
        default step is 0.01 s.

    Returns
    -------
    names, units : list of str
        Of the parameters.
    values, prior_sd : array, parameters
        In the model, and default prior standard deviations [unit of the parameter].
    observed : list of str
        The channels in the order of the rows: those of observe by name, else the coordinate.
    times : list of arrays
        Sample times of each trial [s].
    outputs : list of arrays
        What would be measured of each trial in its unit, channel after channel.
    gamma : list of arrays, samples x parameters
        Sensitivities of each trial [unit of the channel / unit of the parameter], channel after channel.
    fisher : array, parameters x parameters
        Fisher information of all trials together, without priors.
    normalised_sensitivity : array, parameters
        RMS change of the coordinate per prior standard deviation [rad] or [m]; with observe, in
        standard deviations of the noise.
    bound_alone, bound_joint : array, parameters
        Cramér–Rao standard deviations with the other parameters known (inf without information), and
        with all estimated together with their priors.
    identifiable : list of bool
        True: the data at least halve the prior standard deviation.
    correlation : array, parameters x parameters
        Of estimates with the joint bound.
    determined_combinations : int
        Independent combinations whose uncertainty the data at least halve.
    sentences : list of str
        Which parameters are not separately identifiable.
    further_channels : list
        Empty unless asked for; else for each channel that is not observed, the most informative first,

        channel : str
        noise : float
            That is usual in a laboratory [unit].
        unit : str
        information : float
            Half the logarithm of det(I + priors) with the channel over that without it [nats].
        parameter : str
            The one whose joint bound falls most.
        bound_before, bound_after : float
            Its joint bound without and with the channel.

    Raises
    ------
    ValueError
        For no trial, an unknown parameter (with the nearest names), a channel that cannot be measured of
        the model, a noise that is not > 0, a trial with known_mass_in_hand or known_arm_turn, or a
        simulation that does not reach the end of a trial.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> told = fisherhill.sensitivity(model, [trial], ["TRI.radius", "hand.mass"], noise=np.radians(1))
    >>> told.identifiable
    [True, True]
    >>> bool(told.bound_joint[0] < 0.001)  # the radius to less than a millimetre
    True
    """

@type_check_only
class ParameterSweepResult(_Plotted):
    parameter: str
    unit: str
    model_value: float
    time: _Array
    nominal: _Array
    values: _Array
    motions: list[_Array]
    outcome: list[Literal["ok", "unstable", "no solution"]]
    rms_change: _Array
    max_change: _Array

def parameter_sweep(
    model: Model,
    trial: Trial,
    parameter: str,
    values: Sequence[float],
    *,
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> ParameterSweepResult:
    """The motion of a trial for several values of a parameter, all others as in the model.

    Parameters
    ----------
    model : Model
    trial : Trial
    parameter : str
        A name of list_parameters.
    values : list of float
        Within the bounds of the parameter [its unit].
    initial, coordinate, lock, integrator, step
        As in sensitivity, with every integrator of replay.

    Returns
    -------
    parameter, unit : str
    model_value : float
        [unit]
    time : array, times
        [s]
    nominal : array, times
        The first coordinate with the model's own value [rad] or [m].
    values : array, values
    motions : list of arrays
        The first coordinate for each value [rad] or [m]; shorter than time if the motion ended early.
    outcome : list of str
        As in replay.
    rms_change, max_change : array, values
        RMS and largest difference from nominal [rad] or [m].

    Raises
    ------
    ValueError
        For an unknown parameter, a value outside its bounds, or what sensitivity raises.
    """

@type_check_only
class ProfileLikelihoodResult(_Plotted):
    parameter: str
    unit: str
    values: _Array
    costs: _Array
    threshold: float
    bounded_below: bool
    bounded_above: bool
    names: list[str]
    parameters: _Array
    converged: list[bool]

def profile_likelihood(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    profile: str,
    *,
    noise: float = 0.017453292519943295,
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> ProfileLikelihoodResult:
    """How much worse the best fit to the model's own motion becomes as a parameter is held elsewhere.

    The parameter is held at up to thirteen values within three joint Cramér–Rao bounds of the model's
    and within its own bounds; the others are estimated, each with its default prior.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        At least one.
    parameters : list of str
        Names, which may contain *.
    profile : str
        The one that is held.
    noise : float
        Standard deviation of the measured coordinate [rad] or [m] > 0; default: 1 degree.
    initial, coordinate, lock, integrator, step
        As in sensitivity.

    Returns
    -------
    parameter, unit : str
        Of the one that is held.
    values : array, points
        At which it is held [unit].
    costs : array, points
        Least cost, half the sum of the squared residuals and of the squared deviations from the priors,
        each over its standard deviation.
    threshold : float
        Cost below which a value is in the confidence region of 95 %.
    bounded_below, bounded_above : bool
        Whether the cost is above the threshold at the first and at the last of the values.
    names : list of str
        Of all parameters.
    parameters : array, points x parameters
        Where the least cost is attained.
    converged : list of bool

    Raises
    ------
    ValueError
        If profile is not one of the parameters, and what sensitivity raises.
    """

@type_check_only
class MorrisResult:
    mean_absolute: _Array
    sd: _Array
    runs: int
    undefined: int

@type_check_only
class SobolResult:
    first: _Array
    first_sd: _Array
    total: _Array
    total_sd: _Array
    variance: float
    runs: int
    undefined: int

@type_check_only
class GlobalSensitivityResult(_Plotted):
    names: list[str]
    morris: MorrisResult | None
    sobol: SobolResult | None

def global_sensitivity(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    *,
    method: Literal["morris", "sobol", "both"] = "both",
    samples: int = 64,
    seed: int = 1,
    threads: int = 1,
    initial: dict[str, float] = {},
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> GlobalSensitivityResult:
    """Sensitivity of the motion over the whole prior range of the parameters.

    Each parameter is even over its value ± sqrt(3) default prior standard deviations, within its
    bounds; the outputs are the coordinate at the times at which it was measured.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        At least one.
    parameters : list of str
        1 to 32 names, which may contain *.
    method : {'morris', 'sobol', 'both'}
        Morris's screening (1991, with the mean absolute effect of Campolongo et al. 2007), Sobol's
        indices (Saltelli et al. 2010, total: Jansen), or both.
    samples : int
        Trajectories of Morris's method, or base points of Sobol's >= 2; samples (parameters + 1) or
        samples (parameters + 2) simulations.
    seed : int
        The same seed gives the same numbers with any number of threads.
    threads : int
        0: all cores.
    initial
        As in sensitivity.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate, lock, integrator, step
        As in sensitivity.

    Returns
    -------
    names : list of str
        Of the parameters.
    morris : None or, if it was asked for,

        mean_absolute, sd : array, parameters
            Mean absolute elementary effect, and standard deviation of the signed ones, over the whole
            range of a parameter [rad] or [m]; a large sd means nonlinear or interacting effects.
        runs, undefined : int
            Simulations, and those that did not reach the end and were left out.
    sobol : None or, if it was asked for,

        first, total : array, parameters
            Fractions of the variance that a parameter explains alone, and takes part in.
        first_sd, total_sd : array, parameters
            Standard errors over the base points.
        variance : float
            Summed over the outputs [rad2] or [m2].
        runs, undefined : int

    Raises
    ------
    ValueError
        For more than 32 parameters, fewer than two samples, and what sensitivity raises.
    """

@type_check_only
class CostGradientResult(_Table):
    names: list[str]
    units: list[str]
    values: _Array
    cost: float
    gradient: _Array
    excitation_gradient: list[_Array]
    muscles: list[str]

def cost_gradient(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    values: ArrayLike | None = None,
    *,
    noise: float | dict[str, float] = 0.017453292519943295,
    priors: bool = False,
    own_start: bool = False,
    threads: int = 1,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> CostGradientResult:
    """The misfit of simulated and measured motions, and its exact gradient in any number of parameters.

    cost = 1/2 sum(((simulated - measured) / noise)**2) over all measured samples of all trials: the
    negative log-likelihood of Gaussian noise, up to a constant. One sweep back in time gives the
    gradient for the price of about four simulations, however many parameters there are, so that
    gradient-based optimisers can be given hundreds, e.g.::

        def misfit(values):
            at = fisherhill.cost_gradient(model, trials, names, values, priors=True)
            return at.cost, at.gradient

        start = fisherhill.cost_gradient(model, trials, names).values
        scipy.optimize.minimize(misfit, start, jac=True)

    Parameters
    ----------
    model : Model
    trials : list of Trial
        At least one, each with a measured coordinate, speed or marker.
    parameters : list of str
        Names, which may contain *, or ['all']; list_parameters lists them.
    values : array, parameters, optional
        Where to evaluate; default: the model's values.
    noise : float or dict of float
        Standard deviation of the measured values [their unit] > 0; if more than angles was measured,
        of each column by its name, 'angles' for all angles together. Default: 1 degree.
    priors : bool
        True: cost also contains 1/2 sum(((values - model's values) / prior deviation)**2), so that its
        minimum is the most probable set of values.
    own_start : bool
        True: initial values and speeds of each trial are parameters, too, behind the others.
    threads : int
        Trials simulated at once; 0: as many as there are processors.
    coordinate, lock, integrator, step
        As in replay, but the integrator must be variational ('vi', 'vi-left', 'vi-adaptive'), and the
        default step is 0.01 s.

    Returns
    -------
    names, units : list of str
        Of the parameters.
    values : array, parameters
        Where the gradient was taken.
    cost : float
        NaN if a simulation ends before the last measured sample.
    gradient : array, parameters
        Derivatives of the cost [1 / unit of the parameter]; NaN where the cost is.
    excitation_gradient : list of arrays, rows x muscles
        For each trial, derivatives of the misfit in the excitation of each muscle at each row, as it
        drives the muscle: behind what parameters emg.… make of the trial's column.
    muscles : list of str
        Names of these columns: the muscles that are simulated.

    Raises
    ------
    ValueError
        For no trial, an unknown parameter (with the nearest names), another number of values than of
        parameters, noise that is not > 0 or missing, measured moments, forces, lengths or activations,
        or a trial with known_mass_in_hand or known_arm_turn.
    """

@type_check_only
class PredictionResult(_Table):
    names: list[str]
    units: list[str]
    values: _Array
    observed: list[str]
    times: list[_Array]
    outputs: list[_Array]
    gradient: _Array | None
    excitation_gradient: list[_Array] | None
    muscles: list[str]

def predict(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    values: ArrayLike | None = None,
    *,
    weights: Sequence[ArrayLike] | None = None,
    observe: Sequence[str] = [],
    threads: int = 1,
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> PredictionResult:
    """What would be measured with other values of parameters, and derivatives of a weighted sum of it.

    With weights w the gradient is that of sum(w * outputs) over all trials: the transposed Jacobian of
    the outputs times w, by one sweep back in time, which takes about as long as four simulations,
    however many parameters there are. fisherhill.torch and fisherhill.jax are made of this.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        At least one; outputs are at the times at which the coordinate was measured, or at every step.
    parameters : list of str
        Names, which may contain *, or ['all']; list_parameters lists them.
    values : array, parameters, optional
        Where to simulate; default: the model's values.
    weights : list of arrays, optional
        For each trial as many numbers as it has outputs [1 / unit of the output]; default: no gradient.
        Outputs must then be coordinates, speeds or markers.
    observe : list of str
        Channels, named as columns of a trial (sensitivity lists them); default: the first free
        coordinate.
    threads : int
        Trials simulated at once; 0: as many as there are processors.
    initial, coordinate, lock, integrator, step
        As in sensitivity.

    Returns
    -------
    names, units : list of str
        Of the parameters.
    values : array, parameters
        Where it was simulated.
    observed : list of str
        The channels, as in observe.
    times : list of arrays
        Of each trial [s].
    outputs : list of arrays
        Of each trial in the unit of the channel, channel after channel; NaN behind the end of a
        simulation that ends early.
    gradient : array, parameters, or None
        Derivatives of sum(w * outputs) [1 / unit of the parameter]; NaN where a simulation ends early.
    excitation_gradient : list of arrays, rows x muscles, or None
        For each trial, derivatives in the excitation of each muscle at each row.
    muscles : list of str
        Names of these columns: the muscles that are simulated.

    Raises
    ------
    ValueError
        For no trial, an unknown parameter (with the nearest names), another number of values than of
        parameters or of weights than of outputs, a channel that cannot be observed or has no gradient,
        or a trial with known_mass_in_hand or known_arm_turn.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> end = np.zeros(451)
    >>> end[-1] = 1
    >>> found = fisherhill.predict(model, [trial], ["hand.mass"], [0.5], weights=[end])
    >>> bool(found.gradient[0] < 0)  # a heavier hand ends lower
    True
    """

# Ensembles ----------------------------------------------------------------------------------------

@type_check_only
class ParameterLaw:
    name: str
    unit: str
    value: float
    mean: float
    sd: float
    lower: float
    upper: float

@type_check_only
class OutputSpread:
    nominal: float
    mean: float
    sd: float
    p5: float
    p50: float
    p95: float

@type_check_only
class PercentileBand:
    nominal: _Array
    mean: _Array
    p5: _Array
    p50: _Array
    p95: _Array

@type_check_only
class SobolIndices:
    first: _Array
    first_interval: _Array
    total: _Array
    total_interval: _Array
    variance: float
    undefined: int

@type_check_only
class EnsembleChannel:
    name: str
    unit: str
    outputs: dict[str, _Array]
    spread: dict[str, OutputSpread]
    course: _Array
    band: PercentileBand
    sobol: SobolIndices | None
    left_range: int

@type_check_only
class EnsembleResult(_Plotted):
    coordinate: str
    laws: list[ParameterLaw]
    parameters: _Array
    outcome: list[Literal["ok", "unstable", "no solution", "impossible"]]
    failed_at: _Array
    outputs: dict[str, _Array]
    spread: dict[str, OutputSpread]
    time: _Array
    course: _Array
    band: PercentileBand
    sobol: SobolIndices | None
    left_range: int
    channels: list[EnsembleChannel]
    warnings: list[str]

def ensemble(
    model: Model,
    trial: Trial,
    *,
    parameters: Sequence[str] = [],
    draws: int = 1000,
    first: int = 0,
    seed: int = 1,
    distribution: Literal["normal", "uniform"] = "normal",
    spread: float = 1.0,
    prior: dict[str, tuple[float, float]] = {},
    bounds: dict[str, tuple[float, float]] = {},
    covariance: tuple[Sequence[str], ArrayLike] | None = None,
    sobol: bool = False,
    output: Literal["rms_error", "rms_from_nominal", "final", "min", "max"] = "final",
    observe: Sequence[str] = [],
    band_points: int = 46,
    threads: int = 1,
    initial: dict[str, float] = {},
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> EnsembleResult:
    """Simulates a trial with many random draws of the parameters.

    Run i is a function of seed and i alone: the same as in the program's draws.csv, for any number of
    draws and threads.

    Parameters
    ----------
    model : Model
    trial : Trial
    parameters : list of str
        To draw: names, which may contain *, or ['all']; list_parameters lists them. Default: those of
        the covariance, else all.
    draws : int
        Number of simulations >= 1; with sobol number n of base points >= 2, of which each is
        parameters + 2 simulations.
    first : int
        Number of the first run >= 0: portions of an ensemble have the rows of the whole. Not with sobol.
    seed : int
    distribution : {'normal', 'uniform'}
        Normal, or constant over the mean +- sqrt(3) standard deviations; both within the bounds.
    spread : float
        Factor by which every standard deviation is multiplied > 0.
    prior : dict
        {parameter: (mean, standard deviation)} instead of the model's value and the default.
    bounds : dict
        {parameter: (lower, upper)} instead of the defaults.
    covariance : (names, array), optional
        Names of normally distributed parameters, and their covariance, names x names [product of the
        two units]. Means are the model's values. Not with sobol.
    sobol : bool
        True: simulate the points of Saltelli's scheme and compute Sobol's indices.
    output : {'rms_error', 'rms_from_nominal', 'final', 'min', 'max'}
        The output whose variance sobol decomposes.
    observe : list of str
        Observed channels by the names that they have as columns of a trial: 'elbow_flexion',
        'elbow_flexion.moment', 'BRA.fiber_length', ... Default: all free coordinates.
    band_points : int
        Number of times in the percentile band >= 2.
    threads : int
        Simulations at once; 0: as many as there are processors.
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest. Default: as in replay.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate : str or list of str
        The free coordinate, or several. Default: as in replay.
    lock, integrator, step
        As in replay, but the default step is 0.01 s (rk4: 0.0002 s).

    Returns
    -------
    coordinate : str
        Name of the first observed channel, to which outputs, spread, course, band, sobol and left_range
        belong.
    laws : list
        Distribution of each drawn parameter, with

        name, unit : str
        value : float
            In the model.
        mean, sd, lower, upper : float
            Of the distribution, sd before truncation at the bounds.
    parameters : array, runs x parameters
        As drawn.
    outcome : list of str
        Of each run: 'ok', 'unstable', 'no solution', or 'impossible' (no model or no initial state
        exists for these parameters).
    failed_at : array, runs
        Time at which the run ended early [s]; NaN if it did not, or never began.
    outputs : dict
        {output: array, runs} [the channel's unit], NaN unless the run reached the end: 'rms_error'
        against the measurement (NaN without one), 'rms_from_nominal' (RMS difference from the run with
        the model's own parameters), 'final', 'min' and 'max' (last, smallest and largest value).
    spread : dict
        {output: statistics over the runs that reached the end}, each with nominal, mean, sd (sample
        standard deviation), p5, p50, p95 (percentiles).
    time : array, times
        Equally spaced over the trial [s].
    course : array, runs x times
        The channel; NaN unless the run reached the end.
    band : SimpleNamespace
        nominal, mean, p5, p50, p95 : array, times
            The model's own motion; mean and percentiles over the runs that reached the end.
    sobol : SimpleNamespace or None
        first, total : array, parameters
            Fractions of the output's variance: of the parameter alone, and with all its interactions
            (Saltelli et al. 2010; Jansen 1999).
        first_interval, total_interval : array, parameters x 2
            95 % intervals by resampling the base points.
        variance : float
            Of the output [square of the channel's unit].
        undefined : int
            Runs that did not reach the end; their points are left out.
    left_range : int
        Runs in which the coordinate leaves its range by more than a tenth of it; 0 for other channels.
    channels : list
        All observed channels, each with name, unit ('rad', 'm', 'N·m', ..., '' for a pure number) and the
        same outputs, spread, course, band, sobol and left_range.
    warnings : list of str
        Whether the model's own motion leaves the range in which the model is valid.

    Raises
    ------
    ValueError
        For an unknown parameter (with the nearest names), a prior or bounds of one that is not drawn, a
        distribution or covariance that breaks a rule, more than 32 parameters with sobol, an output
        'rms_error' without a measurement, a channel that cannot be observed or is given twice, a trial
        with known_mass_in_hand or known_arm_turn, or a model whose own motion does not reach the end of
        the trial.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> drawn = fisherhill.ensemble(model, trial, parameters=["hand.mass"], draws=4, seed=1)
    >>> drawn.outcome
    ['ok', 'ok', 'ok', 'ok']
    >>> drawn.parameters.shape
    (4, 1)
    """

# Comparisons --------------------------------------------------------------------------------------

@type_check_only
class ConvergedReference:
    status: Literal["confirmed", "disputed", "failed"]
    why: str
    time: _Array
    q: _Array
    relative_tolerance: float
    looser_tolerance: float
    disagreement_rms: float
    disagreement_max: float
    interpolation_rms: float
    second_step: float
    second_rms: float

@type_check_only
class IntegratorRun:
    integrator: Literal["vi", "vi-left", "vi-adaptive", "rk4", "cvode"]
    step: float
    outcome: Literal["ok", "unstable", "no solution"]
    why: str
    failed_at: float
    rms_error: float
    max_error: float
    max_error_at: float
    wall: float
    newton_per_step: float
    halved_steps: int
    energy_error: float
    time: _Array
    q: _Array

@type_check_only
class StepLimit:
    stable: float
    failing: float
    why: str

@type_check_only
class ObservedOrder:
    order: float
    steps: _Array
    errors: _Array

@type_check_only
class CompareResult(_Plotted):
    coordinates: list[str]
    reference: ConvergedReference
    runs: list[IntegratorRun]
    largest_stable_step: dict[str, StepLimit]
    observed_order: dict[str, ObservedOrder]
    also: dict[str, float]
    stable_means_rms_below: float
    warnings: list[str]

def compare(
    model: Model,
    trial: Trial,
    *,
    integrators: Sequence[_Integrator] = ["rk4", "vi", "vi-left", "cvode"],
    steps: Sequence[float] = [0.0002, 0.0003, 0.0005, 0.0008, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05],
    timings: int = 5,
    also: dict[str, _File | tuple[ArrayLike, ArrayLike]] = {},
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
) -> CompareResult:
    """Compares integrators over time steps: error against a converged motion, run time, stability.

    Parameters
    ----------
    model : Model
    trial : Trial
    integrators : list of {'vi', 'vi-left', 'vi-adaptive', 'rk4', 'cvode'}
        Each once; replay explains them.
    steps : list of float
        Time steps [s] > 0, rising; for 'cvode' the interval of its output.
    timings : int
        Least number of runs of each integrator and step, whose median time is reported >= 1.
    also : dict
        {name: motion} of another program to compare with: a table of states with the first free
        rotation (.sto, .mot, .csv), or (times [s], values [rad]).
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest. Default: as in replay.
    coordinate : str or list of str
        The free coordinate, or several; one must be a rotation. Default: as in replay.
    lock : dict
        As in replay.

    Returns
    -------
    coordinates : list of str
        Columns of q.
    reference : SimpleNamespace
        Motion of CVODE with a tight tolerance, with

        status : str
            'confirmed' by 'vi' at a small step, 'disputed' by it, or 'failed': there are no runs.
        why : str
            It is disputed or failed, else empty.
        time, q : array, times; array, times x coordinates
            [s], [rad] or [m].
        relative_tolerance, looser_tolerance : float
            Of this motion, and of the one it is checked with.
        disagreement_rms, disagreement_max : float
            Between these two [rad].
        interpolation_rms : float
            Error of interpolating it between rows [rad].
        second_step, second_rms : float
            Step of 'vi' [s], and its difference [rad].
    runs : list
        By integrator, then by step; each with

        integrator : str
        step : float
            [s]
        outcome, why : str
            'ok', 'unstable' or 'no solution'; the reason, else empty.
        failed_at : float
            [s]; NaN if it reached the end.
        rms_error, max_error, max_error_at : float
            From the reference over all free rotations: RMS and largest [rad], and when [s]. NaN, like
            wall and energy_error, if it did not reach the end.
        wall : float
            Median run time [s].
        newton_per_step : float
            Iterations; 0 for rk4.
        halved_steps : int
            Steps that did not converge in one piece.
        energy_error : float
            Largest [J].
        time, q : array, times; array, times x coordinates
            As far as it came.
    largest_stable_step : dict
        {integrator: limit} of all but cvode, each with

        stable : float
            Largest step found at which the run reaches the end with an RMS error below
            stable_means_rms_below [s]; NaN if none.
        failing : float
            Smallest found at which it does not [s]; NaN if a quarter of the trial is still stable.
        why : str
            It fails there.
    observed_order : dict
        {integrator: order} of the same: order p of an error proportional to step**p (NaN with fewer than
        three usable steps), and steps [s] and errors [rad] of the fit.
    also : dict
        {name: RMS difference of that motion from the reference [rad]}; NaN without a reference.
    stable_means_rms_below : float
        [rad]
    warnings : list of str
        About the model; whether the motion leaves the range in which it is valid.

    Raises
    ------
    ValueError
        For an unknown integrator or one listed twice, steps that do not rise, no free rotation, a
        motion of `also` without the coordinate or at other times, or a trial with known_mass_in_hand or
        known_arm_turn.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> found = fisherhill.compare(model, trial, integrators=["vi"], steps=[0.01], timings=1)
    >>> found.reference.status, found.runs[0].outcome
    ('confirmed', 'ok')
    """

@type_check_only
class MuscleBound:
    value: float
    unit: str
    sd: float

@type_check_only
class MuscleClassMotion:
    name: str
    outcome: Literal["ok", "unstable", "no solution"]
    why: str
    lost: list[str]
    rms: float
    max: float
    max_at: float
    measured_rms: float
    unexplained_rms: float
    determined_combinations: int
    bounds: dict[str, MuscleBound]
    wall: float
    energy_error: float
    time: _Array
    q: _Array

def compare_muscles(
    model: Model,
    trial: Trial,
    *,
    classes: Sequence[str] = ["Schutte1993", "Thelen2003", "Millard2012", "DeGrooteFregly2016", "RigidTendon"],
    noise: float = 0.017453292519943295,
    initial: dict[str, float] = {},
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> _Rows[MuscleClassMotion]:
    """What the class of a model's muscles changes in a motion, all their shared numbers being equal.

    Parameters
    ----------
    model : Model
    trial : Trial
    classes : list of str
        As with_muscles takes them.
    noise : float
        Standard deviation of the measured coordinate [rad] or [m] > 0; default: 1 degree.
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest. Default: as in replay.
    coordinate : str or list of str
        The free coordinate, or several, of which the first is the measured one.
    lock, integrator, step
        As in replay, but the integrator must be variational ('vi', 'vi-left', 'vi-adaptive'), and the
        default step is 0.01 s.

    Returns
    -------
    list
        The model as it is, then with all muscles of each class, each with

        name : str
            'as in the model', or the class.
        outcome, why : str
            'ok', 'unstable' or 'no solution'; the reason, else empty.
        lost : list of str
            Numbers that the class does not have.
        rms, max, max_at : float
            Difference from the first over all free rotations: RMS and largest [rad], and when [s]. NaN,
            like what follows, if the motion does not reach the end.
        measured_rms : float
            RMS difference of the measured coordinate from the first at the measured times [rad] or [m].
        unexplained_rms : float
            What is left of it if the first model's muscle parameters are changed to explain it (linear
            least squares with their priors) [rad] or [m]. Small: data cannot tell the classes apart.
        determined_combinations : int
            Independent combinations of parameters whose uncertainty the data at least halve.
        bounds : dict
            {parameter: bound} of maximal force, optimal fibre length and tendon slack length of every
            muscle: value, unit, and sd, the Cramér–Rao standard deviation with all estimated together.
        wall : float
            Least run time of five [s].
        energy_error : float
            Largest [J].
        time, q : array, times; array, times x coordinates
            As far as it came.

    Raises
    ------
    ValueError
        For an unknown class or integrator, noise that is not > 0, or a trial with known_mass_in_hand or
        known_arm_turn.
    RuntimeError
        If the motion of the model as it is does not reach the end.
    """

# Calibration --------------------------------------------------------------------------------------

@type_check_only
class ParameterEstimate:
    value: float
    sd: float
    lower: float
    upper: float
    unit: str
    model: float
    identifiable: bool
    at_bound: bool
    why: str
    profile: tuple[float, float] | None
    bootstrap: tuple[float, float] | None

@type_check_only
class OtherMinimum:
    values: _Array
    nats: float
    nats_of_data: float

@type_check_only
class HeldOutPrediction:
    trial: str
    channel: str
    unit: str
    peak_measured: float
    peak_predicted: float
    sd_of_estimates: float
    noise: float
    interval: tuple[float, float]
    holds_peak: bool | None
    share_of_samples_held: float

@type_check_only
class CalibrationResult(_Plotted):
    estimates: dict[str, ParameterEstimate]
    correlation: _Array
    other_minima: list[OtherMinimum]
    step: float
    converged: bool
    why: str
    iterations: int
    noise: float
    effective_noise: float
    rmse_before: float
    rmse_after: float
    rmse_held_out_before: float
    rmse_held_out: float
    held_out_predictions: _Rows[HeldOutPrediction]
    model: Model | None

def calibrate(
    model: Model,
    trials: Sequence[Trial],
    parameters: Sequence[str],
    *,
    hold_out: Sequence[Trial] = [],
    noise: float | None = None,
    channel_noise: dict[str, float] = {},
    priors: bool = True,
    prior: dict[str, tuple[float, float]] = {},
    bounds: dict[str, tuple[float, float]] = {},
    loss: Literal["gaussian", "huber", "student"] = "gaussian",
    own_start: bool = False,
    latent: dict[str, tuple[float, float]] = {},
    initial: dict[str, float] = {},
    starts: int = 1,
    seed: int = 1,
    threads: int = 1,
    profile: Sequence[str] = [],
    bootstrap: int = 0,
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> CalibrationResult:
    """Estimates model parameters from measured motions.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        Calibration trials with a measured angle.
    parameters : list of str
        Names of the parameters to estimate; list_parameters lists them.
    hold_out : list of Trial
        Trials used only to test the estimates.
    noise : float, optional
        Standard deviation of the measured angles [rad] > 0. Default: estimated from the residuals.
    channel_noise : dict
        {column: the same of another measured channel, in its unit}, e.g. 'elbow_flexion.moment'.
    priors : bool
        False: estimate without priors; bounds still apply.
    prior : dict
        {name: (mean, sd)} instead of the default prior, in the unit of the parameter.
    bounds : dict
        {name: (low, high)} instead of the default bounds, in the unit of the parameter.
    loss : {'gaussian', 'huber', 'student'}
        Loss function of the residuals; the last two are robust.
    own_start : bool
        True: estimate the initial angle and speed of each trial as well, of a held-out trial with
        the parameters fixed.
    latent : dict
        {muscle: (sd, seconds)}: excitations of muscles without an electrode are estimated about
        the trials' columns, sd being the prior of the log-odds at knots at most so far apart;
        instead of what the trials' headers say. Held-out trials are predicted without.
    initial : dict
        {coordinate: value [rad] or [m]} at the start of every trial, at rest; default: as in replay.
    starts : int
        Number of optimiser starts; the first is the model's own values.
    seed : int
        Seed of the other starts.
    threads : int
        Number of trials simulated at once.
    profile : list of str
        Parameters whose profile likelihood is computed.
    bootstrap : int
        Number of residual-bootstrap replicates, 0 or at least 20.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate, lock, integrator, step
        As in replay, but the integrator must be 'vi', 'vi-left' or 'vi-adaptive'. Without a step it is
        0.01 s, and half as long, down to 0.00125 s, as long as halving it changes angles by more than 0.2
        standard deviations of the noise or an estimate by more than 0.25 of its own.

    Returns
    -------
    estimates : dict
        {name: estimate}, each with

        value, sd, lower, upper : float
            Estimate, standard deviation and 95 % interval [unit]; the last three are NaN without an
            interval. Where the misfit contradicts the Fisher matrix at the ends of its interval,
            these are the ends of the profile likelihood. An interval that encloses another minimum
            has no sd.
        unit : str
        model : float
            Value in the given model [unit].
        identifiable : bool
        at_bound : bool
        why : str
            Why there is no interval, else empty.
        profile, bootstrap : tuple of float, or None
            The 95 % interval of the profile likelihood (infinite on a side where it stays below the
            threshold), and of the bootstrap [unit]; None if it was not asked for or there is none.
    correlation : array, estimates x estimates
    other_minima : list
        Minima that other starts found and that are at least 1 % as likely, or that the data alone
        leave possible: values in the order of the estimates, nats, the cost above that of the
        estimate, and nats_of_data, the same without the priors. The intervals enclose them.
    step : float
        Time step of the estimate [s].
    converged : bool
    why : str
        Why the search ended.
    iterations : int
    noise, effective_noise : float
        Standard deviation of the noise, and after widening for its correlation [rad].
    rmse_before, rmse_after : float
        RMS errors of the calibration trials with the given and the calibrated model [rad].
    rmse_held_out_before, rmse_held_out : float
        The same for the held-out trials; NaN without any.
    held_out_predictions : list
        Of every measured channel of the held-out trials, what the calibrated model predicts, y +- 1.96
        sqrt(sd**2 + noise**2), angles in rad:

        trial, channel, unit : str
        peak_measured, peak_predicted : float
            The values farthest from 0, wherever each is [unit].
        sd_of_estimates : float
            Of the predicted peak, from the covariance of the estimates [unit].
        noise : float
            Of one sample, from the residuals of the calibration trials; NaN, as all that follows from
            it, if none of them has the channel [unit].
        interval : tuple of float
            Of the peak, 95 % [unit].
        holds_peak : bool or None
            Whether the measured peak is in the interval; None: the noise is unknown.
        share_of_samples_held : float
            Of all samples, within the interval of their own prediction.
    model : Model or None
        The calibrated model.

    Raises
    ------
    ValueError
        For an unknown parameter, a trial without a measured angle or with an external torque,
        known_mass_in_hand or known_arm_turn, a trial that is given twice or both held out and used
        for estimation (by its content), or an option out of range.
    RuntimeError
        If no estimate is possible, with the reason.

    Examples
    --------
    >>> model = fisherhill.load_model("models/elbow8.osim")
    >>> trial = fisherhill.load_trial("emg_data/curl_slow.sto", model)
    >>> fit = fisherhill.calibrate(model, [trial], ["hand.mass"], step=0.02)
    >>> fit.converged, round(fit.estimates["hand.mass"].value, 2)
    (True, 0.76)
    >>> fit.rmse_after < fit.rmse_before
    True
    """

# Design of experiments ----------------------------------------------------------------------------

@type_check_only
class DesignMonteCarlo:
    mean: _Array
    sd: _Array
    bound: _Array
    converged: int
    trials: int

@type_check_only
class DesignResult(_Plotted):
    improved: bool
    names: list[str]
    units: list[str]
    values: _Array
    of_interest: list[bool]
    prior_sd: _Array
    bound_before: _Array
    bound_after: _Array
    columns: dict[str, _Array]
    trial: Trial
    times: _Array
    observed: list[str]
    predicted: _Array
    predicted_before: _Array
    surprise: _Array
    bound_over_time: _Array
    bound_over_time_before: _Array
    coordinates: list[str]
    lowest: float | _Array
    highest: float | _Array
    surprised_lowest: float | _Array
    surprised_highest: float | _Array
    largest_speed: float | _Array
    largest_torque: float | _Array
    largest_torque_rate: float | _Array
    largest_excitation_rate: float
    costs: _Array
    found_at: list[int]
    simulations: int
    impossible_simulations: int
    monte_carlo: DesignMonteCarlo | None

def design(
    model: Model,
    trial: Trial,
    parameters: Sequence[str],
    *,
    nuisance: Sequence[str] = [],
    priors: bool = False,
    prior: dict[str, float] = {},
    criterion: Literal["E", "A", "D"] = "E",
    observe: dict[str, float] = {},
    noise: float = 0.008726646259971648,
    rate: float = 100.0,
    torque: float | dict[str, float] = 10.0,
    torque_rate: float = 50.0,
    excite: Sequence[str] = [],
    excitation_max: float = 0.5,
    excitation_rate: float = 2.0,
    range: tuple[float, float] | dict[str, tuple[float, float]] | None = None,
    speed: float | dict[str, float] = 8.726646259971648,
    surprise: float = 0.5,
    knots: float = 0.3,
    candidates: int = 100,
    generations: int = 100,
    iterations: int = 10,
    monte_carlo: int = 0,
    seed: int = 1,
    threads: int = 1,
    initial: dict[str, float] = {},
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> DesignResult:
    """Finds the excitations and the external torques that are most informative about parameters.

    Inputs are piecewise linear between knots, within limits of size and rate. With I the information
    about the parameters of interest, the nuisance parameters unknown, in units of the default prior
    standard deviations, the search makes least

        E: -ln(least eigenvalue of I)    A: ln(trace of the inverse of I)    D: -ln det I

    and keeps to the range and the speed of every free coordinate.

    Parameters
    ----------
    model : Model
    trial : Trial
        The baseline to improve on: excitations, duration, initial state.
    parameters, nuisance : list of str
        Parameters of interest, and further unknown ones, with their default priors; names may contain *.
    priors : bool
        True: default priors for the parameters of interest as well.
    prior : dict
        {parameter: prior standard deviation [its unit] > 0} instead of the default.
    criterion : {'E', 'A', 'D'}
    observe : dict
        {what is measured: standard deviation of its noise, in its unit > 0}, as of sensitivity; default:
        all free coordinates, with noise.
    noise : float
        Standard deviation of the free coordinates [rad] or [m] > 0; default: 0.5 degrees.
    rate : float
        Measurements per second [Hz] > 0.
    torque : float or dict
        Largest external torque [N m] or force [N] >= 0 on every free coordinate (0: none), or
        {coordinate: torque}, none on others.
    torque_rate : float
        How fast it may change [N m/s] or [N/s] > 0.
    excite : list of str
        Muscles whose excitations are designed: 'flexors', 'extensors' (of the first coordinate; of another:
        'NAME.flexors'), or names; 'BRA+BRD' share one.
    excitation_max, excitation_rate : float
        Largest excitation of them (0.01 to 1), and its rate [1/s] > 0.
    range : (float, float) or dict, optional
        To which the coordinate is limited [rad] or [m], or {coordinate: (float, float)}; default: as in
        the model.
    speed : float or dict
        Largest speed of every free coordinate [rad/s] or [m/s] > 0, or {coordinate: speed}; default: 500
        degrees per second.
    surprise : float
        Ranges are respected even if the parameters are so many prior standard deviations off.
    knots : float
        Interval between the knots [s] > 0.
    candidates, generations, iterations : int
        Random initial designs, generations of the evolution strategy from the best of them, iterations
        of the final gradient search.
    monte_carlo : int
        Simulated and estimated repetitions of the designed experiment, to confirm the bounds; needs no
        nuisance parameters.
    seed, threads : int
        The same seed gives the same numbers with any number of threads; 0 threads: all cores.
    initial
        As in sensitivity. Prescribed coordinates move as in the trial.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction of the search, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate, lock, integrator, step
        As in sensitivity. Prescribed coordinates move as in the trial.

    Returns
    -------
    improved : bool
        False: no experiment within the limits is better than trial, which is then what is returned.
    names, units : list of str
        Of the parameters of interest, then of the nuisance parameters.
    values, prior_sd : array, parameters
        In the model, and prior standard deviations [unit], inf without a prior.
    of_interest : list of bool
    bound_before, bound_after : array, parameters
        Cramér-Rao standard deviations in the baseline and in the designed experiment [unit].
    columns : dict
        {name: array, times} of the designed experiment, as make_trial takes them: time, excitations,
        torques, prescribed coordinates, and what is predicted where it is measured, else nan.
    trial : Trial
        The same.
    observed : list of str
    times : array, measurements
        [s]
    predicted, predicted_before, surprise : array, measurements (several: x observed)
        What is observed, in the baseline, and how far off it is with parameters off by surprise.
    bound_over_time, bound_over_time_before : array, measurements
        Bound on the first parameter from the measurements up to each time [unit]; nan: none.
    coordinates : list of str
        Those that are free.
    lowest, highest, surprised_lowest, surprised_highest : float (several: array, coordinates)
        Of them, and with parameters off [rad] or [m].
    largest_speed, largest_torque, largest_torque_rate : float (several: array, coordinates)
        [rad/s] or [m/s], [N m] or [N], and that per second.
    largest_excitation_rate : float
        [1/s]
    costs : array
        The criterion of the baseline, then of each better experiment within the limits.
    found_at : list of int
        Simulations until each of these was found.
    simulations, impossible_simulations : int
        Simulations with sensitivities, and those that did not reach the end.
    monte_carlo : None or, if it was asked for,

        mean, sd, bound : array, parameters of interest
            Of the estimates, and the Cramér-Rao bound [unit].
        converged, trials : int

    Raises
    ------
    ValueError
        For an unknown parameter or muscle, a limit out of its range, nothing to change, an integrator
        without sensitivities, what cannot be measured, a torque on a prescribed coordinate, a trial with
        known_mass_in_hand or known_arm_turn.
    RuntimeError
        If the baseline does not reach its end.
    """

@type_check_only
class SeparateResult:
    improved: bool
    effects: list[str]
    size: dict[str, float]
    unit: dict[str, str]
    nats_before: dict[str, float]
    nats_after: dict[str, float]
    bound_before: dict[str, float]
    bound_after: dict[str, float]
    columns: dict[str, _Array]
    trial: Trial
    times: _Array
    observed: list[str]
    predicted: _Array
    predicted_with: dict[str, _Array]
    coordinates: list[str]
    lowest: float | _Array
    highest: float | _Array
    largest_speed: float | _Array
    largest_torque: float | _Array
    largest_torque_rate: float | _Array
    largest_excitation_rate: float
    nats: _Array
    found_at: list[int]
    simulations: int
    impossible_simulations: int

def separate(
    model: Model,
    trial: Trial,
    first: str,
    second: str,
    *,
    size: dict[str, float] = {},
    observe: dict[str, float] = {},
    noise: float = 0.008726646259971648,
    rate: float = 100.0,
    torque: float | dict[str, float] = 10.0,
    torque_rate: float = 50.0,
    excite: Sequence[str] = [],
    excitation_max: float = 0.5,
    excitation_rate: float = 2.0,
    range: tuple[float, float] | dict[str, tuple[float, float]] | None = None,
    speed: float | dict[str, float] = 8.726646259971648,
    knots: float = 0.3,
    candidates: int = 100,
    generations: int = 100,
    seed: int = 1,
    threads: int = 1,
    initial: dict[str, float] = {},
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> SeparateResult:
    """Finds the experiment that best discriminates two effects of discover's catalogue.

    It makes the smaller of both expected log Bayes factors largest, with every parameter of the model
    uncertain by its default prior. The motions without an effect and with either keep to the range and
    the speed of every free coordinate, all of which must be observed.

    Parameters
    ----------
    model : Model
    trial : Trial
        The baseline to improve on.
    first, second : str
        Effects, by id or long name.
    size : dict
        {effect: assumed size in its unit}; default: its prior standard deviation.
    observe, noise, rate, torque, torque_rate, excite, excitation_max, excitation_rate, range, speed, knots
        As in design.
    candidates, generations, seed, threads
        As in design; there is no gradient search.
    initial
        As in design.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate, lock, integrator, step
        As in design.

    Returns
    -------
    improved : bool
        False: no experiment within the limits is better than trial, which is then what is returned.
    effects : list of str
        Both ids.
    size, unit : dict
        Assumed size of each, and its unit.
    nats_before, nats_after : dict
        Expected log Bayes factor over the other effect if it is the one that is present, in the baseline
        and in the designed experiment.
    bound_before, bound_after : dict
        Expected standard deviation of its size [unit].
    columns, trial
        The designed experiment, as of design; predictions are those of the model without an effect.
    times, observed
        As of design.
    predicted : array, measurements (several: x observed)
        Without an effect.
    predicted_with : dict
        {effect: array, measurements (several: x observed)} with each effect.
    coordinates, lowest, highest, largest_speed
        As of design, of all three motions.
    largest_torque, largest_torque_rate, largest_excitation_rate
        As of design.
    nats : array
        Smaller log Bayes factor in the baseline, then in each better experiment within the limits.
    found_at : list of int
        Experiments simulated until each of these was found.
    simulations, impossible_simulations : int
        Experiments that were simulated, and those that did not reach the end.

    Raises
    ------
    ValueError
        For an unknown effect, one that the model has, a size out of its bounds, and what design raises.
    """

@type_check_only
class DynamometerExperiment:
    kind: Literal["isometric", "isokinetic", "passive", "release", "isotonic"]
    start: float
    end: float
    speed: float
    muscles: str
    effort: float
    load: float
    torque: float
    instruction: str
    information: float
    bounds: _Array
    columns: dict[str, _Array]
    trial: Trial

@type_check_only
class DynamometerDesignResult(_Table):
    names: list[str]
    units: list[str]
    bound_before: _Array
    bound_after: _Array
    experiments: list[DynamometerExperiment]
    candidates: int
    candidates_not_simulated: int
    candidates_unsuitable: int

def design_on_dynamometer(
    model: Model,
    coordinate: str,
    parameters: Sequence[str],
    *,
    nuisance: Sequence[str] = [],
    kinds: Sequence[Literal["isometric", "isokinetic", "passive", "release", "isotonic"]] = [],
    angles: Sequence[float] = [],
    speeds: Sequence[float] = [],
    efforts: Sequence[float] = [],
    releases: Sequence[float] = [],
    release_speed: float | None = None,
    loads: Sequence[float] = [],
    experiments: int = 4,
    moment_noise: float = 0.5,
    noise: float = 0.008726646259971648,
    rate: float = 100.0,
    speed: float = 8.726646259971648,
    surprise: float = 0.5,
    threads: int = 1,
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> DynamometerDesignResult:
    """Ranks what a dynamometer can do by what it tells of parameters.

    A dynamometer holds or turns the coordinate and measures its moment, or lets it go against a torque
    and measures its angle; flexors and extensors contract in turn. One experiment after the other is
    chosen, each the one that adds most to what those before tell, none twice.

    Parameters
    ----------
    model : Model
    coordinate : str
        Held and turned; all others are locked.
    parameters, nuisance : list of str
        Parameters of interest, and further unknown ones; names may contain *. All have their default
        priors.
    kinds : list of {'isometric', 'isokinetic', 'passive', 'release', 'isotonic'}
        Experiments that it can do; default: all.
    angles : list of float
        To hold [rad] or [m]; turns go between the first and the last. Default: four in the range.
    speeds : list of float
        Of turns [rad/s] or [m/s]; default: 30 and 120 degrees (or mm) per second, as far as they fit.
    efforts : list of float
        Contractions as shares of the maximum voluntary one (0.01 to 1); default: 0.3, 0.6, 1.
    releases : list of float
        How far muscles shorten in a quick release [rad] or [m]; default: 10 degrees (or mm).
    release_speed : float, optional
        Largest speed of a release [rad/s] or [m/s]; default: 200 degrees (or mm) per second, less where
        rate (eight samples in a release) or speed require it.
    loads : list of float
        Torque of isotonic contractions over what holds the contracted limb (0 to 1); default: 0.5, 0.8.
    experiments : int
        How many are wanted.
    moment_noise : float
        Standard deviation of a sample of the moment [N m] or [N] > 0.
    noise : float
        Of a sample of the angle, in isotonic contractions [rad] or [m] > 0; default: 0.5 degrees.
    rate : float
        Samples per second [Hz] > 0.
    speed, surprise : float
        As in design, of isotonic contractions; speed limits turns and releases as well.
    threads : int
        0: all cores.
    lock, integrator, step
        As in sensitivity.

    Returns
    -------
    names, units : list of str
        Of the parameters of interest.
    bound_before, bound_after : array, parameters
        Default prior standard deviations, and Cramér-Rao bounds after all experiments [unit].
    experiments : list
        In the order in which they are chosen:

        kind : str
        start, end : float
            Coordinate at begin and end; of an isotonic contraction the end as predicted [rad] or [m].
        speed : float
            Of the turn, of a release the largest [rad/s] or [m/s]; 0: held, or free.
        muscles : str
            'flexors', 'extensors', or empty: all relaxed.
        effort, load : float
            Their excitation, and the share of the holding torque (isotonic), 0 to 1.
        torque : float
            On the coordinate, in its direction (isotonic) [N m] or [N].
        instruction : str
            To the person on the dynamometer.
        information : float
            That it adds [nats].
        bounds : array, parameters
            After it and those before it [unit].
        columns : dict
            {name: array, times} as make_trial takes them, with prescribe=[coordinate] unless isotonic;
            what is measured is to be filled in (isotonic: replaces the predicted coordinate).
        trial : Trial
            The same.
    candidates, candidates_not_simulated, candidates_unsuitable : int
        Experiments considered; those that cannot be simulated; those that would leave the range, are too
        fast, or do not carry the limb.

    Raises
    ------
    ValueError
        For an unknown coordinate, parameter or kind, a value out of its range, or a list for kinds that
        are left out.
    RuntimeError
        If none of the experiments can be simulated.
    """

# Discovery ----------------------------------------------------------------------------------------

@type_check_only
class EffectParameter:
    value: float
    sd: float
    unit: str

@type_check_only
class Effect:
    id: str
    name: str
    kind: Literal["structure", "input", "geometry", "sensor", "parameter"]
    parameters: dict[str, EffectParameter]
    log_bayes_factor: float
    probability: float
    cannot_be_told_from: list[str]
    moment_rms: float
    moment_peak: float
    share_of_muscle_moment: float
    motion_rms: float

@type_check_only
class ExcessError:
    nominal: float
    calibrated: float
    after: float
    expected: float | None
    probability: float | None
    noise_floor: float
    closed: float | None

@type_check_only
class PlannedExperiment:
    what: str
    of: str
    expected_nats: dict[str, float]

@type_check_only
class FormulaTerm:
    expression: str
    value: float
    sd: float

@type_check_only
class RacedFormula:
    formula: str
    wins: bool
    terms: list[FormulaTerm]
    log_bayes_factor: float
    amplitude_over_sd: float
    adequate: bool
    gap: ExcessError
    gap_held_out: ExcessError | None

@type_check_only
class UnknownForce:
    axis: str
    formula: str
    stable: bool
    evidence: float
    explained: float
    peak_frequency: float
    rms: float
    raced: RacedFormula | None

@type_check_only
class NonparametricForce:
    axis: str
    follows: Literal["angle", "position", "speed"]
    beside: list[str]
    log_bayes_factor: float
    nats_ahead_of_names: float
    wins: bool
    at: _Array
    force: _Array
    sd: _Array

@type_check_only
class DiscoveryStart:
    coordinate: str
    value: float
    speed: float

@type_check_only
class DiscoveryOutput:
    name: str
    unit: str
    noise: float

@type_check_only
class DiscoveryTrial:
    name: str
    role: Literal["train", "held_out"]
    nominal: float
    after: float
    noise_floor: float
    start: float | None
    start_speed: float | None
    starts: list[DiscoveryStart]
    trial: Trial

@type_check_only
class FittedParameter:
    name: str
    unit: str
    nominal: float
    estimate: float
    sd: float
    prior_sd: float
    prior_z: float

@type_check_only
class DiscoveryResult(_Plotted):
    verdict: Literal["named", "ambiguous", "parameter", "none", "unknown", "numerical"]
    sentence: str
    effects: list[Effect]
    surrogate: bool
    probability_vetoed: bool
    noise: float
    outputs: list[DiscoveryOutput]
    gap: ExcessError
    gap_held_out: ExcessError | None
    held_out_fitted: bool
    replicated: bool | None
    input_correlation: float
    remedies: list[str]
    position_break: float | None
    trials_are_cut: bool
    undetectable_below: dict[str, float]
    planned_experiments: list[PlannedExperiment]
    unknown: UnknownForce | None
    force_without_a_name: NonparametricForce | None
    model: Model | None
    trials: list[DiscoveryTrial]
    fitted_parameters: _Rows[FittedParameter]
    step: float
    fits: int

def discover(
    model: Model,
    trials: Sequence[Trial],
    *,
    hold_out: Sequence[Trial] = [],
    noise: float | dict[str, float] | None = None,
    without: Sequence[str] = [],
    effects: Sequence[_File] = [],
    max_effects: int = 3,
    input_scatter: float | None = None,
    initial: dict[str, float] = {},
    progress: _Progress = False,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    integrator: _Integrator = "vi",
    step: float | None = None,
) -> DiscoveryResult:
    """Finds and names the effect that a model lacks.

    Parameters
    ----------
    model : Model
    trials : list of Trial
        Trials with measured coordinates, moments or other channels. known_mass_in_hand and known_arm_turn are taken into
        account.
    hold_out : list of Trial
        Trials used to test the result.
    noise : float or dict, optional
        Standard deviation of every measured angle [rad], or of the only channel that is measured; or
        {channel: standard deviation in its unit} of all of them. Default: estimated from the data.
    without : list of str
        Ids of effects to exclude from the catalogue.
    effects : list of str or PathLike
        TOML files of effects of your own, forces by a formula, to be looked for beside the catalogue.
    max_effects : int
        Largest number of effects in one hypothesis.
    input_scatter : float, optional
        Noise of the EMG that is tolerated, as a fraction of each muscle's moment, >= 0; a larger residual
        counts as a missing effect. Default: 0.075.
    initial : dict
        {coordinate: initial value [rad] or [m]}, at rest: where the search expects every trial to begin.
        Default: the first measured value.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.
    coordinate : str or list of str
        Free coordinates, which are in question. Where none is free, those that are prescribed and whose
        moment the trials measure are. Default: the measured ones.
    lock : dict
        As in replay.
    integrator : {'vi', 'vi-left', 'vi-adaptive'}
    step : float, optional
        Time step [s] > 0. Default: 0.01 s, halved where this is too long.

    Returns
    -------
    verdict : str
        'named', 'ambiguous' (effects that these data cannot distinguish), 'parameter' (a parameter of
        the model is in error), 'none', 'unknown' (something is missing that no effect of the catalogue
        explains) or 'numerical' (the time step is too long; the effects are those found with it).
    sentence : str
        The verdict in words.
    effects : list
        For each effect:

        id, name : str
        kind : str
            'structure', 'input', 'geometry', 'sensor' or 'parameter'.
        parameters : dict
            {name: value, sd, unit}.
        log_bayes_factor : float
            [nats]
        probability : float
            Compared with the effects that could take its place; NaN of a proxy.
        cannot_be_told_from : list of str
            Ids of the effects that these data cannot distinguish, this one first.
        moment_rms, moment_peak : float
            [N m] or [N], in the first held-out trial, else the first trial; NaN if undefined, as for
            an effect of the sensor.
        share_of_muscle_moment : float
            moment_rms as a fraction of the muscles' net moment (RMS).
        motion_rms : float
            RMS change of the motion of the first coordinate [rad] or [m].
    surrogate : bool
        True: the effects are only proxies of an effect outside the catalogue.
    probability_vetoed : bool
        True: no probability of the verdict is given, since the residuals or the errors of held-out
        trials contradict it.
    noise : float
        Standard deviation of the noise that was used [rad] or [m], of the first output.
    outputs : list
        For each measured channel: name, unit and noise [unit].
    gap, gap_held_out
        RMS errors [rad] or [m] of the trials and of the held-out trials (None without any); of several
        outputs in standard deviations of their noise, times that of the first:

        nominal, calibrated, after : float
            With the given model, with its parameters fitted, and with the effects as well.
        expected : float or None
            Expected value of `after`; for held-out trials only.
        probability : float or None
            p-value of an error at least as large as `after`; for held-out trials only.
        noise_floor : float
        closed : float or None
            Fraction of the excess error of the calibrated model that the effects explain; None if
            there is no excess error.
    held_out_fitted : bool
        True: the effect was found only when the held-out trials were fitted as well.
    replicated : bool or None
        Whether held-out trials that are not as predicted show the same effects when fitted by
        themselves; None if this was not asked.
    input_correlation : float
        Correlation of the muscles' moments with those that the recorded motion requires; NaN if it
        cannot be told.
    remedies : list of str
        Changes of the recording with which excitations and motion agree; if there is one, the recording
        contradicts itself, and no effect was looked for.
    position_break : float or None
        Position [rad] or [m] at which the base model lacks a force at once; None if there is none,
        or if the effect is known without.
    trials_are_cut : bool
        True: only what comes before `position_break` in each trial was used.
    undetectable_below : dict
        {id: smallest detectable amplitude}; inf: the data cannot show the effect.
    planned_experiments : list
        If effects cannot be distinguished, experiments that would distinguish them, the best first:

        what : str
            What to do.
        of : str
            The leading effects, ids joined by ' + '.
        expected_nats : dict
            {rival: expected log Bayes factor of `of` against it [nats]}.
    unknown
        If no effect fits, the missing force, else None:

        axis : str
            Coordinate that it acts on.
        formula : str
        stable : bool
            True: every term is selected in 90 % of the bootstrap samples.
        evidence : float
            Of the formula [nats].
        explained : float
            Fraction of the missing force's power that the formula explains.
        peak_frequency : float
            [Hz]
        rms : float
            [N m] or [N]
        raced
            The formula fitted as a candidate effect, or None: formula, wins (True: as a named effect
            it would have no rival), terms (expression, value, sd), log_bayes_factor [nats],
            amplitude_over_sd, adequate (True: the residuals pass every test), gap, gap_held_out.
    force_without_a_name
        The best free-form force, a smooth function of one coordinate or of its speed alone, or None:

        axis : str
            Coordinate that it acts on and follows.
        follows : str
            'angle', 'position' (of a coordinate that slides) or 'speed'.
        beside : list of str
            Ids of the effects that were fitted with it.
        log_bayes_factor : float
            [nats]
        nats_ahead_of_names : float
            Log Bayes factor against the named effects [nats].
        wins : bool
            True: the named effects are probably only proxies.
        at : array
            Angles [rad] or speeds [rad/s], or [m] or [m/s].
        force, sd : array
            The force there, and its standard deviation [N m] or [N].
    model : Model or None
        The model with the effects, if any, and all fitted parameters; also of effects that are only
        proxies or were found with a step that is too long, which its credits say. None where
        something is missing and no effect was found.
    trials : list
        For each trial:

        name : str
        role : str
            'train' or 'held_out'.
        nominal, after : float
            RMS errors [rad] or [m] in replay with the given and the returned model; NaN if unavailable.
        noise_floor : float
            Noise of the trial that was replayed [rad] or [m].
        start, start_speed : float or None
            Fitted initial value [rad] or [m] and speed [rad/s] or [m/s] of one free coordinate; None
            unless one is free.
        starts : list
            The same of every free coordinate: coordinate, value, speed.
        trial : Trial
            The one to replay with the returned model.
    fitted_parameters : list
        For each: name, unit, nominal, estimate, sd, prior_sd [unit], and prior_z, the difference from
        the prior mean in prior standard deviations; NaN if there is none.
    step : float
        Time step [s].
    fits : int
        Number of fits.

    Raises
    ------
    ValueError
        For no coordinate in question, a trial in which nothing of it was measured, a trial that is
        given twice or both held out and used for estimation (by its content), an unknown id, or an
        option out of range.
    """

@type_check_only
class ListedEffect:
    id: str
    long_id: str
    name: str
    kind: Literal["structure", "input", "geometry", "sensor", "parameter"]
    meaning: str
    parameters: dict[str, str]
    equivalents: list[str]

@type_check_only
class EffectList(_Table):
    effects: list[ListedEffect]
    present: dict[str, str]

def list_effects(
    model: Model,
    *,
    coordinate: str | Sequence[str] = [],
    lock: dict[str, float] = {},
    effects: Sequence[_File] = [],
) -> EffectList:
    """Lists the effects that discover looks for in the model.

    Parameters
    ----------
    model : Model
    coordinate, lock
        As in discover. Default of the coordinate: those that the model does not lock.
    effects : list of str or PathLike
        As in discover.

    Returns
    -------
    effects : list
        Each with

        id, long_id, name : str
            Short and long id, both of which `without` of discover takes, and the name.
        kind : str
            As of the effects that discover names.
        meaning : str
            A sentence.
        parameters : dict
            {name: unit}
        equivalents : list of str
            Ids of effects that the same data never distinguish from it.
    present : dict
        {id: what the model has of it already}, which are not looked for.

    Raises
    ------
    ValueError
        For an unknown coordinate, and what discover raises for effects.
    """

@type_check_only
class RobotEffect:
    id: str
    name: str
    kind: Literal["structure", "input", "geometry", "sensor", "parameter"]
    parameters: dict[str, EffectParameter]
    log_bayes_factor: float
    probability: float
    cannot_be_told_from: list[str]

@type_check_only
class RobotDiscoveryResult(_Plotted):
    verdict: Literal["named", "ambiguous", "parameter", "none", "unknown", "numerical"]
    sentence: str
    effects: list[RobotEffect]
    surrogate: bool
    probability_vetoed: bool
    noise: dict[str, float]
    gap: ExcessError
    gap_held_out: ExcessError | None
    held_out_fitted: bool
    replicated: bool | None
    undetectable_below: dict[str, float]
    unknown: UnknownForce | None
    force_without_a_name: NonparametricForce | None
    fitted_parameters: _Rows[FittedParameter]
    already_in_the_model: list[str]
    warnings: list[str]
    step: float
    fits: int

_RobotTrial: TypeAlias = _File | _Columns

def discover_robot(
    system: Literal["double-pendulum", "suspended-mass"],
    trials: Sequence[_RobotTrial],
    *,
    hold_out: Sequence[_RobotTrial] = [],
    with_effects: _File | Sequence[RobotEffect] | None = None,
    noise: float | Sequence[float] | None = None,
    without: Sequence[str] = [],
    max_effects: int = 3,
    step: float | None = None,
    input_scatter: float | None = None,
    ignore_extra: bool = False,
    progress: _Progress = False,
) -> RobotDiscoveryResult:
    """Finds and names the effect that a robot's model lacks.

    Parameters
    ----------
    system : {'double-pendulum', 'suspended-mass'}
        Two links on a cart, with measured angles, or a mass on a string below a cart, with the measured
        force of the string.
    trials : list of str, PathLike, dict or DataFrame
        Files, or {column: values}: time [s], input (the cart's commanded acceleration [m/s^2]), and
        link1_rad and link2_rad (absolute angles from hanging down [rad]; or link1_deg and link2_deg) or
        force_N; NaN: not measured. The cart is at rest before.
    hold_out : list of str, PathLike, dict or DataFrame
        Trials used to test the result.
    with_effects : str, PathLike or list, optional
        Effects to add to the model first: a with_effect.json, or the effects of an earlier result.
    noise : float or list of float, optional
        Standard deviation of each measured column, link1 and link2 [rad] or force [N]. Default:
        estimated from the data.
    without : list of str
        Ids of effects to exclude from the catalogue.
    max_effects : int
        Largest number of effects in one hypothesis.
    step : float, optional
        Time step [s] > 0. Default: 0.005 s, halved where this is too long.
    input_scatter : float, optional
        Error of the cart's acceleration that is tolerated [m/s^2], >= 0; a larger residual counts as a
        missing effect. Default: 0.075.
    ignore_extra : bool
        Ignore unknown columns.
    progress : bool or callable
        True: a bar (tqdm); a function: called with the fraction done, 0 to 1, now and then; what it
        raises ends the computation.

    Returns
    -------
    verdict, sentence : str
        As discover.
    effects : list
        For each effect: id, name, kind, parameters, log_bayes_factor, probability and
        cannot_be_told_from as discover.
    surrogate, probability_vetoed : bool
        As discover.
    noise : dict
        {channel: standard deviation of the noise that was used [rad] or [N]}.
    gap, gap_held_out
        As discover, in [rad] or [N]; errors of link2 are weighted by the ratio of the two noises.
    held_out_fitted : bool
        As discover.
    replicated : bool or None
        As discover.
    undetectable_below : dict
        As discover.
    unknown, force_without_a_name
        As discover; the force is an acceleration of the cart [m/s^2].
    fitted_parameters : list
        As discover.
    already_in_the_model : list of str
        Ids of the effects of with_effects that are no candidates any more.
    warnings : list of str
        Columns that were ignored.
    step : float
        Time step [s].
    fits : int
        Number of fits.

    Raises
    ------
    ValueError
        For an unknown system, a table that breaks a rule, a trial given twice, an unknown id, a step
        longer than a trial, or an option out of range.
    """

# Studies ------------------------------------------------------------------------------------------

@type_check_only
class StudyRecording:
    file: str
    config: str
    held_out: bool

@type_check_only
class StudySubject:
    name: str
    model: str
    train: list[str]
    hold_out: list[str]
    recordings: list[StudyRecording]
    set: list[str]

@type_check_only
class StudyFile:
    title: str
    parameters: list[str]
    own_start: bool
    priors: bool
    noise: float | None
    starts: int
    discover: bool
    max_effects: int
    without: list[str]
    coordinates: list[str]
    lock: list[str]
    set: list[str]
    step: float | None
    subjects: list[StudySubject]

def read_study(file: _File) -> StudyFile:
    """Reads a study: subjects with their models and trials, and what is to be estimated from them.

    Parameters
    ----------
    file : str or PathLike
        (.toml); docs/study.md lists every key. Paths in it are relative to its folder.

    Returns
    -------
    title : str
    parameters : list of str
        To estimate; empty: nothing is calibrated.
    own_start, priors : bool
    noise : float or None
        Of the measured angle [rad]; None: from the data.
    starts : int
    discover : bool
        Whether a missing effect is looked for.
    max_effects : int
    without, coordinates, lock, set : list of str
        As the program takes them, e.g. lock 'shoulder_elv=30deg', set 'TRI.radius=0.018'.
    step : float or None
        [s]
    subjects : list
        Each with

        name, model : str
        train, hold_out : list of str
            Trials.
        recordings : list
            Of raw EMG, of which trials are made: file, config, and held_out.
        set : list of str
            Numbers of its model, beside those of the study.

    Raises
    ------
    ValueError
        If the file cannot be read, or for an unknown key or a value that breaks a rule; the line names
        file, line and key.
    """

@type_check_only
class StudyRow:
    subject: str
    status: Literal["ok", "failed", "not converged", "no solution"]
    rmse_before: float
    rmse_after: float
    rmse_held_out_before: float
    rmse_held_out: float
    noise: float
    identifiable: int
    parameters: int
    verdict: str
    effects: list[str]
    probability: float
    sentence: str
    message: str
    calibration: CalibrationResult | None
    discovery: DiscoveryResult | None

def study(
    file: _File,
    *,
    subjects: Sequence[str] | None = None,
    each: Callable[[StudyRow], object] | None = None,
    seed: int = 1,
    threads: int = 1,
    progress: _Progress = False,
) -> _PlottedRows[StudyRow]:
    """Carries the subjects of a study through emg, calibrate with its held-out test, and discover.

    What cannot be carried out for a subject is the status and message of its row and does not stop
    the others. One subject is computed after the other. With `each`, an interruption loses nothing
    but the subject at work, and the study goes on with those that are left:

        done = {}  # or what an earlier session wrote to a file
        left = [one.name for one in read_study(file).subjects if one.name not in done]
        study(file, subjects=left, each=lambda row: done.update({row.subject: row}))

    Parameters
    ----------
    file : str or PathLike
        As in read_study.
    subjects : list of str, optional
        Names of those to compute. Default: all.
    each : callable, optional
        each(row) gets each row as soon as it is computed; what it raises ends the study.
    seed : int
        Of calibrate.
    threads : int
        Of calibrate.
    progress : bool or callable
        As of calibrate; the fraction of the subjects that are done.

    Returns
    -------
    list
        A row for every subject asked for, in the order of the file, each with

        subject : str
        status : str
            'ok', 'failed', or of calibrate 'not converged' or 'no solution'.
        rmse_before, rmse_after, rmse_held_out_before, rmse_held_out : float
            RMS error of the training and held-out trials with the given and the calibrated model [rad];
            NaN without.
        noise : float
            Of the measured angle [rad]; NaN without a calibration.
        identifiable, parameters : int
            Of how many of the estimated parameters the data at least halve the uncertainty.
        verdict, sentence : str
            Of discover; empty without.
        effects : list of str
            Ids of the effects that it names.
        probability : float
            Of the first; NaN without.
        message : str
            What failed, or why the calibration did not converge; else empty.
        calibration, discovery : SimpleNamespace or None
            What calibrate and discover returned.

    Raises
    ------
    ValueError
        As read_study does, and for a name that is no subject's.
    """

# Pages --------------------------------------------------------------------------------------------

def explore(
    model: _File,
    trials: _File | Sequence[_File],
    out: _File,
    *,
    verdict: _File = "",
    parameters: str | Sequence[str] = (),
    noise: float = 0.017453292519943295,
    values: dict[str, float] = {},
    prescribe: str | Sequence[str] = (),
    initial: dict[str, float] = {},
    wrap_as_cylinder: str | Sequence[str] = (),
    ignore_extra: bool = False,
    force: bool = False,
    coordinate: str | Sequence[str] = (),
    lock: dict[str, float] = {},
    integrator: Literal["vi", "vi-left", "rk4"] = "vi",
    step: float | None = None,
) -> str:
    """Writes a page that simulates: parameters as sliders, curves, the limb in 3-D; one file, offline.

    The program `fisherhill` writes it, which must be on the PATH, or named in the environment variable
    FISHERHILL_PROGRAM.

    Parameters
    ----------
    model : str or PathLike
        File of the model; Model.write makes one.
    trials : str or PathLike, or list of these
        Files of trials.
    out : str or PathLike
        Folder for the page.
    verdict : str or PathLike
        Folder of a result of `fisherhill discover`: the page shows its model with and without the
        effect; empty: none.
    parameters : str or list of str
        Names of parameters with a slider, which may contain *; default: the twelve that move the motion
        most.
    noise : float
        Standard deviation of measured angles [rad], for what the trials say of the parameters; default:
        1 degree, and 1 mm for translations.
    values : dict
        {parameter: value} with which the page begins, as in Model.with_parameters.
    prescribe : str or list of str
        As in load_trial.
    initial : dict
        {coordinate: initial value [rad] or [m]}.
    wrap_as_cylinder : str or list of str
        Wrap ellipsoids to replace by cylinders, as Model.with_cylinders does.
    ignore_extra : bool
        As in load_trial.
    force : bool
        True: replace a result that is in the folder.
    coordinate, lock, integrator, step
        As in replay, but a page has no 'cvode'.

    Returns
    -------
    str
        File name of the page.

    Raises
    ------
    ValueError
        What the program says of bad input, in one line.
    RuntimeError
        If the program is not there, or fails.
    """

# Robots -------------------------------------------------------------------------------------------

@type_check_only
class RobotTrials:
    trials: int
    converged: int
    mean: _Array
    covariance: _Array
    estimates: _Array

@type_check_only
class RobotInformationResult:
    names: list[str]
    units: list[str]
    truth: _Array
    information: _Array
    bound: _Array | None
    eigenvalues: _Array
    determined_directions: int
    sentences: list[str]
    determined: list[str]
    undetermined_directions: list[str]
    trials: RobotTrials | None

def robot_information(
    robot: Literal["double-pendulum", "suspended-mass"],
    *,
    amplitude: float | None = None,
    period: float | None = None,
    unknown: Sequence[str] = [],
    undamped: bool = False,
    trials: int = 0,
    seed: int = 1,
    threads: int = 1,
) -> RobotInformationResult:
    """Information of an experiment with a robot about two of its parameters.

    The cart moves by amplitude (1 - cos(2 pi t / period)) for 5 s.

    Parameters
    ----------
    robot : {'double-pendulum', 'suspended-mass'}
        Two links on a cart, their angles measured at 30 Hz: mass of the first link and damping of the
        joints are unknown. Or a mass on a string below a cart, the string's force measured at 100 Hz:
        mass and length are unknown.
    amplitude : float, optional
        [m] > 0. Default: 0.05, of the suspended mass 0.0476.
    period : float, optional
        [s] > 0. Default: 5.
    unknown : list of str
        ['m1', 'c'] or ['m1', 'm2'], of the double pendulum. Default: ['m1', 'c'].
    undamped : bool
        True: no damping; with ['m1', 'm2'] only.
    trials : int
        Number of simulated experiments with independent noise, each estimated from an initial guess
        drawn between 0 and 2 times the true values; 0: none.
    seed : int
    threads : int
        0: all cores. The result does not depend on it.

    Returns
    -------
    names, units : list of str
        Of the parameters.
    truth : array, 2
        The values at which the information holds.
    information : array, 2 x 2
        Fisher information of one experiment.
    bound : array, 2 x 2, or None
        Cramer-Rao bound, the smallest covariance of unbiased estimates; None if the parameters are not
        separately identifiable.
    eigenvalues : array, 2
        Of the information, rising.
    determined_directions : int
        Number of combinations of the parameters that the experiment determines.
    sentences : list of str
        The result in words.
    determined : list of str
        Combinations that are determined although their parameters are not.
    undetermined_directions : list of str
        Changes of the parameters that leave all outputs unchanged.
    trials
        trials and converged (numbers of simulated experiments and of converged estimates), mean,
        covariance, estimates (of those that converged, one a row); None without any.

    Raises
    ------
    ValueError
        For an unknown robot or parameter, or an option out of range.
    """

@type_check_only
class RobotMotion:
    time: _Array
    input: _Array
    states: _Array
    information: _Array

@type_check_only
class RobustInformation:
    candidates: _Array
    initial: _Array
    nominal: _Array
    robust: _Array

@type_check_only
class LaboratoryResult:
    recordings: int
    truth: _Array
    start: _Array
    estimate_before: _Array
    estimate_after: _Array
    median_error_before: _Array
    median_error_after: _Array

@type_check_only
class RobotMotionResult:
    names: list[str]
    units: list[str]
    state_names: list[str]
    before: RobotMotion
    after: RobotMotion
    iterations: int
    motions_tried: int
    converged: bool
    why: str
    costs: _Array
    slopes: _Array
    steps: _Array
    information_before: _Array
    information_after: _Array
    bound_before: _Array
    bound_after: _Array
    trials_before: RobotTrials | None
    trials_after: RobotTrials | None
    estimator_iterations_before: dict[str, int] | None
    estimator_iterations_after: dict[str, int] | None
    robust: RobustInformation | None
    laboratory: LaboratoryResult | None

def optimise_robot_motion(
    robot: Literal["double-pendulum", "suspended-mass"],
    *,
    discrete: bool = False,
    amplitude: float | None = None,
    period: float | None = None,
    perturb: float | None = None,
    warm_start: ArrayLike | None = None,
    objective: dict[str, float] | None = None,
    input_weight: float | None = None,
    limits: tuple[float, float] | None = None,
    tolerance: float | None = None,
    iterations: int | None = None,
    robust: Literal["worst", "average"] | None = None,
    candidates: Sequence[tuple[float, float]] = [],
    measure_every: int = 1,
    lab: bool | dict[str, float] = False,
    trials: int = 300,
    seed: int = 1,
    threads: int = 1,
) -> RobotMotionResult:
    """Searches the motion of a robot that is most informative about two of its parameters.

    The search minimises J = phi(I) + (R/2) int (u - u0)^2 dt by the projection operator, with the
    Fisher information I, phi = e/lambda_min + a tr I^-1 - d ln det I + condition lambda_max/lambda_min,
    the cart's input u and the initial input u0. A search that makes no progress is a result.

    Parameters
    ----------
    robot : {'double-pendulum', 'suspended-mass'}
        As robot_information.
    discrete : bool
        True: the motion of the variational integrator in steps of 0.02 s, whose input is the cart's
        position [m]; double pendulum only. Else the input is the cart's acceleration [m/s^2].
    amplitude : float, optional
        Of the initial motion [m] >= 0: amplitude (1 - cos(2 pi t / period)), with `discrete` amplitude
        sin(2 pi t / period). Default: 0.05, with `discrete` 0.01, of the suspended mass 0.0476.
    period : float, optional
        Of the initial motion [s] > 0. Default: 5.
    perturb : float, optional
        Size > 0 of a smooth random motion that is added to the initial input [its unit].
    warm_start : array, optional
        Input to start from, such as `after.input` of an earlier result.
    objective : dict, optional
        {criterion: weight} with 'e', 'a', 'd' and 'condition'. Default: the robot's own.
    input_weight : float, optional
        R >= 0. Default: the robot's own.
    limits : tuple, optional
        Lower and upper limit of the input.
    tolerance : float, optional
        The search ends when the expected decrease of J is below this, >= 0. Default: 0.1, with
        `discrete` 0.01.
    iterations : int, optional
        Largest number, >= 0. Default: 100.
    robust : {'worst', 'average'}, optional
        Optimise the worst case or the average over several values of the parameters.
    candidates : list of tuple
        These values, with `robust` only. Default: the model's values, and each alone +-30 %.
    measure_every : int
        Steps between measurements, >= 1; with `discrete` only.
    lab : bool or dict
        Estimate from recordings of both motions that are simulated with effects which the model lacks:
        True for those of usual size, or sizes by name: out_of_plane [rad], dry_friction [N m],
        control_lag [s], control_noise [m/s^2], sensor_curvature, sensor_step [rad] or [N]. Not with
        `discrete`.
    trials : int
        Simulated experiments with each motion of the double pendulum, >= 1.
    seed : int
        Of the perturbation, the trials and the laboratory.
    threads : int
        0: all cores. The result does not depend on it.

    Returns
    -------
    names, units : list of str
        Of the parameters.
    state_names : list of str
        With units.
    before, after
        The initial and the optimised motion:

        time : array, times
            [s]
        input : array, times
        states : array, times x states
        information : array, times x 2 x 2
            Fisher information of all measurements up to each time.
    iterations, motions_tried : int
    converged : bool
    why : str
        Why the search ended.
    costs : array, iterations + 1
        J at the start and after each iteration.
    slopes, steps : array
        Expected decrease of J for a step of 1 (< 0) at each iteration, and the steps taken.
    information_before, information_after : array, 2 x 2
        As the search takes it: of the double pendulum in continuous time that of one sample a second,
        else of the experiment.
    bound_before, bound_after : array, 2 x 2
        Cramer-Rao bounds of one experiment.
    trials_before, trials_after
        As `trials` of robot_information; None of the suspended mass.
    estimator_iterations_before, estimator_iterations_after : dict or None
        Of the suspended mass: {estimator: iterations on exact data}; 1001: not converged.
    robust
        With `robust` the smallest eigenvalue of the information for each of `candidates` (one a row):
        initial (motion), nominal (optimised for the first alone), robust; else None.
    laboratory
        With `lab` recordings (of each motion), truth, start (initial guess), estimate_before and
        estimate_after (from the first recording), median_error_before and median_error_after (relative,
        of all recordings); else None.

    Raises
    ------
    ValueError
        If the initial motion has no information about a combination of the parameters, or for an option
        out of range.
    """

@type_check_only
class EstimatorConvergence:
    method: Literal["gradient descent", "iterated least squares", "Newton-Raphson"]
    iterations: int
    converged: bool
    parameters: _Array
    cost: _Array
    error: _Array
    ratio: _Array
    order: _Array
    mean_ratio: float

@type_check_only
class EstimatorComparisonResult:
    quiet: list[EstimatorConvergence]
    lively: list[EstimatorConvergence]

def compare_robot_estimators(
    *, amplitude: float | None = None, period: float | None = None, seed: int = 1
) -> EstimatorComparisonResult:
    """Convergence of three estimators of mass and string length of the suspended mass.

    They are gradient descent, iterated least squares and Newton-Raphson.

    Parameters
    ----------
    amplitude, period : float, optional
        Of the quiet motion, as robot_information.
    seed : int
        Of the noise.

    Returns
    -------
    quiet : list
        With exact data, for each estimator:

        method : str
        iterations : int
        converged : bool
        parameters : array, 2
            Mass [kg] and length [m].
        cost, error, ratio, order : array, iterations + 1
            Cost, relative error, error divided by the last one, and order of convergence; NaN where
            undefined.
        mean_ratio : float
            Of the errors of successive iterations.
    lively : list
        The same for a motion of 0.1 m and 1.2 s, one recording with noise.

    Raises
    ------
    ValueError
        For an option out of range.
    """

@type_check_only
class LengthEstimates:
    time: _Array
    length: _Array
    length_sd: _Array
    mass: _Array
    mass_sd: _Array
    converged: list[bool]

@type_check_only
class ArmSamples:
    time: _Array
    reference: _Array
    position: _Array
    acceleration: _Array
    force: _Array
    predicted_force: _Array
    information: _Array

@type_check_only
class Swing:
    success: bool
    why: str
    crossing_height: float
    time: _Array
    gripper: _Array
    ball_x: _Array
    ball_z: _Array

@type_check_only
class StringLengthTrial:
    initial_length: float
    length: float
    length_sd: float
    mass: float
    estimates: LengthEstimates
    samples: ArmSamples
    clipped_samples: int
    least_tension: float
    deadline_misses: int
    swing_without: Swing
    swing_with: Swing

@type_check_only
class StringLengthResult:
    trials: list[StringLengthTrial]
    mean: float
    sd: float
    largest_error: float
    successes_without: int
    successes_with: int

def estimate_string_length(
    initial_lengths: Sequence[float] = [],
    *,
    duration: float = 6.0,
    payload: float = 0.2,
    true_length: float = 0.368,
    noise: float = 0.1,
    disturbance: float = 0.5,
    tracking_weight: float = 20.0,
    window: float = 0.0,
    estimate_mass: bool = False,
    ignore_clipping: bool = False,
    search_time: bool = False,
    real_time: bool = False,
    seed: int = 1,
) -> StringLengthResult:
    """A robot arm estimates the length of a string while it moves, then swings the ball into a box.

    The arm moves a mass on a string such that the measured force is informative about the string's
    length. The swing is planned with the initial and with the estimated length, and carried out on the
    true string.

    Parameters
    ----------
    initial_lengths : list of float
        Initial estimates [m], 0.05 to 1.5, one for each trial. Default: nine from 0.308 to 0.468.
    duration : float
        Of a trial [s] > 0.
    payload : float
        Mass on the string [kg] > 0, known unless `estimate_mass`.
    true_length : float
        [m] > 0
    noise : float
        Standard deviation of the load cell's noise [N] > 0.
    disturbance : float
        Unmeasured acceleration of the string's top [m/s^2] >= 0.
    tracking_weight : float
        Weight of tracking the middle position, > 0; without it nothing would move.
    window : float
        Length of the estimation window [s], at least 0.1; 0: all data since the start.
    estimate_mass : bool
        Estimate the mass as well, from 0.8 times its value.
    ignore_clipping : bool
        Treat clipped samples as measurements.
    search_time : bool
        Let the controller postpone its action to a better time.
    real_time : bool
        Run four threads in real time, each at its own rate; takes `duration` for each trial.
    seed : int

    Returns
    -------
    trials : list
        Each with

        initial_length, length, length_sd, mass : float
            Initial and final estimate, its standard deviation [m], and the mass [kg].
        estimates
            In the course of the trial: time [s], length, length_sd [m], mass, mass_sd [kg], converged.
        samples
            time [s], reference and position [m] and acceleration [m/s^2] of the gripper, force and
            predicted_force [N], information about the length so far [1/m^2].
        clipped_samples : int
        least_tension : float
            [N]; <= 0: the string was slack, where the model is not valid.
        deadline_misses : int
            Of the controller.
        swing_without, swing_with
            The swings planned with the initial and with the estimated length: success, why,
            crossing_height (of the ball at the near wall above the edge [m]; NaN without a plan),
            time [s], gripper, ball_x, ball_z [m].
    mean, sd : float
        Of the final estimates [m].
    largest_error : float
        [m]
    successes_without, successes_with : int
        Number of swings that end in the box.

    Raises
    ------
    ValueError
        For an option out of range, or if nothing would move.
    """

# Systems defined in Python ------------------------------------------------------------------------

class System:
    """A system defined by Python functions: x' = f(x, u, theta, t), y = g(x, u, theta).

    Steps are those of the classical Runge-Kutta method, with u linear between the times.

    Parameters
    ----------
    f : callable
        f(x, u, theta, t) returns x', as long as the state.
    x0 : array, states
        Initial state.
    times : array, samples
        Sample times [s], strictly rising.
    inputs : array, samples x inputs, optional
        Default: u is empty.
    g : callable, optional
        g(x, u, theta) returns the outputs; default: the state.
    f_x, f_theta : callable, optional
        Jacobians of f, states x states and states x parameters, with the arguments of f. If they are
        given, sensitivities are those of the steps exactly, else central differences.
    g_x, g_theta : callable, optional
        Jacobians of g, outputs x states and outputs x parameters, with the arguments of g.
    substeps : int
        Steps from one time to the next, at least 1.

    Raises
    ------
    ValueError
        For times that do not rise, sizes that do not fit, f_x without f_theta or the reverse, or f_x
        with g but without g_x and g_theta. What the functions raise comes back unchanged.
    """

    def __init__(
        self,
        f: Callable[[_Array, _Array, _Array, float], ArrayLike],
        x0: ArrayLike,
        times: ArrayLike,
        *,
        inputs: ArrayLike | None = None,
        g: Callable[[_Array, _Array, _Array], ArrayLike] | None = None,
        f_x: Callable[[_Array, _Array, _Array, float], ArrayLike] | None = None,
        f_theta: Callable[[_Array, _Array, _Array, float], ArrayLike] | None = None,
        g_x: Callable[[_Array, _Array, _Array], ArrayLike] | None = None,
        g_theta: Callable[[_Array, _Array, _Array], ArrayLike] | None = None,
        substeps: int = 1,
    ) -> None: ...
    def __call__(self, theta: ArrayLike) -> _Array:
        """Simulates the outputs.

        Parameters
        ----------
        theta : array, parameters

        Returns
        -------
        array, samples x outputs
        """

    def sensitivities(self, theta: ArrayLike) -> _Array:
        """Derivatives of the outputs with respect to the parameters.

        Parameters
        ----------
        theta : array, parameters

        Returns
        -------
        array, (samples * outputs) x parameters
            dy/dtheta, the outputs of the first sample first.
        """

    @property
    def times(self) -> _Array:
        """Sample times [s]."""

def fisher_information(gamma: ArrayLike, noise: ArrayLike, *, outputs: int = 1) -> _Array:
    """Fisher information, the sum over samples of gamma^T Sigma^-1 gamma.

    Parameters
    ----------
    gamma : array
        Sensitivities: samples x outputs x parameters, or (samples * outputs) x parameters with
        `outputs` given.
    noise : float or array
        Standard deviation of the outputs > 0, one for each output, or their covariance, outputs x
        outputs.
    outputs : int
        Number of outputs of one sample; not used for three dimensions.

    Returns
    -------
    array, parameters x parameters
        [1 / (unit of one parameter * unit of the other)]

    Raises
    ------
    ValueError
        For shapes that do not fit, a noise that is not > 0, or values that are not finite.

    Examples
    --------
    >>> gamma = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]])  # of a line: offset and slope
    >>> fisherhill.fisher_information(gamma, noise=0.5)
    array([[12., 12.],
           [12., 20.]])
    """

def cramer_rao_bound(information: ArrayLike, names: Sequence[str] = []) -> _Array:
    """Cramér–Rao bound, the inverse of the information: no unbiased estimator has a smaller covariance.

    Parameters
    ----------
    information : array, parameters x parameters
    names : list of str
        Of the parameters, for messages.

    Returns
    -------
    array, parameters x parameters
        Covariance.

    Raises
    ------
    ValueError
        If the matrix is not symmetric but for rounding, or if there is no information about a parameter
        or a combination of parameters, which it names.

    Examples
    --------
    >>> fisherhill.cramer_rao_bound([[4.0, 0.0], [0.0, 100.0]])
    array([[0.25, 0.  ],
           [0.  , 0.01]])
    """

@type_check_only
class IdentifiabilityResult(_Plotted):
    names: list[str]
    values: _Array
    rank: int
    sentences: list[str]
    sd: _Array
    correlation: _Array
    determined: list[str]

def identifiability(
    information: ArrayLike, values: ArrayLike, names: Sequence[str] = []
) -> IdentifiabilityResult:
    """Which parameters, or combinations of them, are identifiable near the given values.

    Parameters
    ----------
    information : array, parameters x parameters
    values : array, parameters
        Values at which the information was computed. Combinations are products of powers, or sums if a
        value is 0.
    names : list of str
        Of the parameters.

    Returns
    -------
    names : list of str
    values : array, parameters
        As they were given.
    rank : int
        Number of combinations that are determined.
    sentences : list of str
    sd : array, parameters
        Cramér–Rao standard deviations; inf where undetermined.
    correlation : array, parameters x parameters
        NaN where undetermined.
    determined : list of str
        Combinations that are determined of parameters that are not.

    Raises
    ------
    ValueError
        For sizes that do not fit, or an information that is not finite or not symmetric but for
        rounding.

    Examples
    --------
    >>> told = fisherhill.identifiability([[1.0, 1.0], [1.0, 1.0]], [2.0, 3.0], ["a", "b"])
    >>> told.rank
    1
    >>> told.determined
    ['a²·b³']
    """

@type_check_only
class EstimateResult(_Table):
    parameters: _Array
    names: list[str]
    converged: bool
    why: str
    cost: float
    iterations: int
    evaluations: int
    information: _Array
    covariance: _Array
    sd: _Array
    intervals: _Array
    at_bound: list[bool]
    reduced_chi_square: float

def estimate(
    predict: Callable[[_Array], ArrayLike] | System,
    measured: ArrayLike,
    noise: ArrayLike,
    start: ArrayLike,
    *,
    names: Sequence[str] = [],
    sensitivities: Callable[[_Array], ArrayLike] | None = None,
    bounds: dict[str, tuple[float, float]] = {},
    prior: dict[str, tuple[float, float]] = {},
    method: Literal["levenberg-marquardt", "gauss-newton", "gradient-descent"] = "levenberg-marquardt",
    iterations: int = 100,
    confidence: float = 0.95,
) -> EstimateResult:
    """Weighted least squares with bounds and priors.

    Parameters
    ----------
    predict : callable or System
        predict(theta) returns samples x outputs, as `measured`.
    measured : array, samples x outputs
        NaN: not measured. One dimension: samples of one output.
    noise : float or array
        As in fisher_information.
    start : array, parameters
        Start values of the parameters.
    names : list of str
        Of the parameters.
    sensitivities : callable, optional
        sensitivities(theta) returns samples x outputs x parameters, or (samples * outputs) x
        parameters. Default: predict.sensitivities, else central differences.
    bounds : dict
        {name: (low, high)}.
    prior : dict
        {name: (mean, sd)}.
    method : {'levenberg-marquardt', 'gauss-newton', 'gradient-descent'}
    iterations : int
        Largest number of iterations.
    confidence : float
        Of the intervals, between 0 and 1.

    Returns
    -------
    parameters : array, parameters
        The estimates.
    names : list of str
    converged : bool
    why : str
        Why the search ended.
    cost : float
        Half the weighted sum of squares, priors included.
    iterations, evaluations : int
        Steps taken, and predictions computed.
    information, covariance : array, parameters x parameters
        At the estimate, priors included; the covariance is the Cramér–Rao bound.
    sd : array, parameters
    intervals : array, parameters x 2
        Lower and upper ends.
    at_bound : list of bool
        True: the estimate is at a bound, and its interval does not hold.
    reduced_chi_square : float
        Near 1 if model and noise fit the data.

    Raises
    ------
    ValueError
        For shapes that do not fit, an unknown name or method, an option out of range, a prediction at
        the start that is not finite, or a parameter without prior that changes no prediction there.
        What `predict` raises comes back unchanged.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 2.0])
    >>> found = fisherhill.estimate(lambda p: p[0] + p[1] * x, [1.0, 3.0, 5.0], 0.1, [0.0, 0.0], names=["offset", "slope"])
    >>> [round(float(one), 6) for one in found.parameters]
    [1.0, 2.0]
    """
