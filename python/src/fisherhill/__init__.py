"""Hill muscles and Fisher information: simulate, identify and explain how muscles move limbs."""

from ._fisherhill import (
    Model,
    System,
    Trial,
    __version__,
    calibrate,
    cramer_rao_bound,
    discover,
    estimate,
    fisher_information,
    identifiability,
    list_parameters,
    load_model,
    load_trial,
    make_trial,
    replay,
    sensitivity,
)

__all__ = [
    "Model",
    "System",
    "Trial",
    "calibrate",
    "cramer_rao_bound",
    "discover",
    "estimate",
    "fisher_information",
    "identifiability",
    "list_parameters",
    "load_model",
    "load_trial",
    "make_trial",
    "replay",
    "sensitivity",
]
