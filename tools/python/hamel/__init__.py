"""hamel: geometric integrators for nonholonomic systems on Lie groups.

>>> import hamel
>>> result = hamel.run("suslov", inertia=[1, 10, 100], momentum=[1, 1, 0], scheme="lift",
...                    step=0.01, until=20)
>>> bool(result), result["omega1"].shape
(True, (2001,))

The names are those of C++ (`<hamel/simulate.hpp>`) and of the command line; `help(hamel.run)` lists
the options of a run. Invalid arguments raise `hamel.ConfigError`, a ValueError with every mistake;
a numerical failure is in `result.status`. Long calls release the interpreter to other threads.
"""

from hamel._hamel import (
    WORLD as WORLD,
    Config as Config,
    ConfigError as ConfigError,
    Description as Description,
    EnsembleResult as EnsembleResult,
    Equations as Equations,
    EventMet as EventMet,
    EventState as EventState,
    Input as Input,
    InputTable as InputTable,
    Fit as Fit,
    FittedNumber as FittedNumber,
    Gradient as Gradient,
    Jacobian as Jacobian,
    Linearisation as Linearisation,
    Mechanism as Mechanism,
    Parameter as Parameter,
    Recorded as Recorded,
    Plan as Plan,
    Result as Result,
    Rows as Rows,
    Run as Run,
    Section as Section,
    SectionOrbit as SectionOrbit,
    Sensitivities as Sensitivities,
    Simulation as Simulation,
    SolverStats as SolverStats,
    State as State,
    Status as Status,
    SteadyCrossing as SteadyCrossing,
    SteadyEnd as SteadyEnd,
    SteadyMotion as SteadyMotion,
    SteadyPlace as SteadyPlace,
    SteadySweep as SteadySweep,
    StudyResult as StudyResult,
    SystemText as SystemText,
    Unfinished as Unfinished,
    __version__ as __version__,
    describe as describe,
    ensemble as ensemble,
    equations as equations,
    fit as fit,
    linearisation as linearisation,
    names as _names,
    plan as plan,
    read_recorded as read_recorded,
    retractions as retractions,
    run as run,
    section as section,
    sensitivities as sensitivities,
    simulate as simulate,
    steady as steady,
    study as study,
)

list = _names
