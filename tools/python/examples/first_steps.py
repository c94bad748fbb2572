"""First steps: a run, its numbers and its record; a mechanism by parts; steady motions."""

# %% A registered system by its name; parameters and options are keywords.
import numpy as np

import hamel

result = hamel.run(
    "suslov", inertia=[2, 3, 4], momentum=[1, 1, 0], scheme="lift", step=0.01, until=20
)
print(result)

# %% Rows are NumPy views, indexed by columns or by the names of the velocities.
t, omega = result.t, result["xi"]  # shapes (2001,), (2001, 3)
print("omega1 in", result.units["omega1"], "ends at", result["omega1"][-1])
speed = np.linalg.norm(omega, axis=1)
print("the body turns at", speed.min(), "to", speed.max(), "rad/s")

# %% The error. The exact motion of this system is known; otherwise check=True estimates the error.
print("error against the exact motion:", result.exact_error_max)
checked = hamel.run("rattleback", step=0.002, until=1, scheme="lift", check=True)
print(f"rattleback: error about {checked.estimated_error:.1e}, order {checked.observed_order:.2f}")

# %% Events: a run ends where an event occurs.
turned = hamel.run("chaplygin_sleigh", until=20, events=["cusp"])
for event in turned.events:
    print(event.name, "at", event.time, "s")

# %% A mechanism by its parts; no equation is derived by hand.
cart = hamel.Mechanism("cart_and_trailer")
cart.body("cart", mass=10, at=[0, 0, 0.1], box=[0.5, 0.3, 0.1])
cart.body("trailer", mass=5, at=[-1.3, 0, 0.1], box=[0.4, 0.3, 0.1])
cart.planar("floor", "cart")
cart.hinge("hitch", "cart", "trailer", at=[-0.35, 0, 0.1], damping=0.5)
cart.blade("cart axle", "cart")
cart.blade("trailer axle", "trailer", at=[-1.3, 0, 0])
cart.start({"v1": 1, "omega": 0, "hitch.angle": 0.8})
motion = hamel.run(cart, until=8)
print("the hitch straightens from", motion["hitch.angle"][0], "to", motion["hitch.angle"][-1])

# %% A system defined by formulas, in a text: it runs as fast as a compiled one of its size.
skate = """
group = "se2"
coordinates = ["theta", "x", "y"]
inertia = ["J", "m", "m"]
constraints = [[0, 0, 1]]
potential = "m*g*sin(slope)*x"
velocity = [1, 0.5, 0]
[parameters]
m = { value = 70, unit = "kg" }
J = { value = 1, unit = "kg m^2" }
g = 9.81
slope = 0.05
"""
slide = hamel.run(skate, until=5, slope=0.1)
print("a skate on a slope of 0.1 is at x =", slide["x"][-1], "m after 5 s")

# %% Steady motions: the speeds at which a bicycle is stable.
sweep = hamel.steady("bicycle", vary=("speed", 1, 8, 29))
weave, capsize = (crossing.value for crossing in sweep.crossings)
print(f"stable from {weave:.3f} to {capsize:.3f} m/s")

# %% Invalid arguments raise one exception with every mistake, before anything runs.
try:
    hamel.run("suslof", scheme="lfit", s=1.5)
except hamel.ConfigError as error:
    print(len(error.mistakes), "mistakes:", error.mistakes[0])

assert result and result.exact_error_max < 1e-3
assert turned.events and abs(motion["hitch.angle"][-1]) < 0.4
assert 4 < weave < 5 < capsize < 7
