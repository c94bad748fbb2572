"""A segway balanced and steered by state feedback at 200 Hz in Python; without it, it falls."""

# %% The motors' torques at a state, to run at `speed` and turn at `rate`. The gains on the pitch,
# its rate and the speed place the poles of the upright motion at -1, -3 and -4 per second.
import time

import hamel


def feedback(run: hamel.Run, speed: float, rate: float) -> None:
    total = 217 * run["pitch"] + 41 * run["pitch'"] + 7 * (run["v1"] - speed)
    difference = 10 * (rate - run["omega"])
    run.input("right_torque", (total + difference) / 2)
    run.input("left_torque", (total - difference) / 2)


# %% A run by hand: a first value declares an input of the run.
PERIOD, END = 0.005, 15.0
segway = hamel.simulate("segway").step(0.001).input("right_torque", 0).build()
path: list[tuple[float, float]] = []
largest = 0.0
begin = time.perf_counter()
for k in range(round(END / PERIOD)):
    slow = k * PERIOD >= END / 2
    feedback(segway, speed=0.5 if slow else 1.0, rate=-0.5 if slow else 0.5)
    if not (status := segway.advance_to((k + 1) * PERIOD)):
        raise SystemExit(status.reason)
    largest = max(largest, abs(segway["pitch"]))
    path.append((segway["x"], segway["y"]))
times_real = END / (time.perf_counter() - begin)
print(
    f"balanced: pitch at most {largest:.3f} rad; runs at {segway['v1']:.3f} m/s and turns at "
    f"{segway['omega']:.3f} rad/s; {times_real:.0f} times real time"
)

# %% Without the motors, from the same start; an observer ends the run.
fallen = hamel.run("segway", step=0.001, until=5, observe=lambda now: abs(now.coordinates[5]) < 1)
print(f"without: the pitch is 1 rad after {fallen.last.time:.2f} s")

assert largest < 0.3
assert abs(segway["v1"] - 0.5) < 0.01 and abs(segway["omega"] + 0.5) < 0.01
assert fallen.last.time < 3
