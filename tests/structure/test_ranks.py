"""Two ranks give the serial answer."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

SCRIPT = """
import sys
import meshes, numpy as np
from structure import *

tube = meshes.tube(outer_radius=0.05, inner_radius=0.04)
line = tube.outer_polyline
comm = tube.domain.comm
material = PlaneStrain(youngs_modulus=70e7, poissons_ratio=0.35, density=2700.0)
loads = [BoundaryLoad(boundary="loaded_arc", total_force=(0.0, -100.0), schedule=Ramp(over=2e-3)),
         PointLoad(point=(0.0, -0.05), force=(0.0, 90.0)), BodyForce(acceleration=(1.0, -9.81)),
         PointLoad(point=(0.0306, 0.0317), force=(5.0, 0.0), schedule=Sine(frequency=300.0, offset=0.5)),
         Pressure(boundary="inner", pressure=3e3, schedule=Table(times=(0.0, 1e-3, 4e-3), factors=(0.0, 1.0, -1.0)))]
following = [*loads, Pressure(boundary="inner", pressure=4e3, follows=True),
             Pressure(boundary="free_arc", pressure=500.0, follows=True, schedule=Ramp(over=3e-3))]
damping = Rayleigh(mass_factor=0.5, stiffness_factor=1e-5)
body = ElasticStructure(
    tube, material=material, time_step=4e-5, damping=damping, loads=loads, element="standard")
bent = ElasticStructure(
    tube, material=material, time_step=4e-5, damping=damping, loads=loads, element="enhanced")
free = FreeRigid(tube, density=2700.0, time_step=4e-5, loads=following)
# Two that turn by 1.8 rad.
frame, large = (ElasticStructure(
    tube, material=material, time_step=4e-5, damping=Rayleigh(stiffness_factor=1e-5), loads=following, theory=theory)
    for theory in ("corotational", "large_strain"))
for spun in (frame, large):
    spun.set_initial(velocity=300.0 * np.column_stack([-tube.points[:, 1], tube.points[:, 0]]))
rng = np.random.default_rng(11)
out = {}
for step in range(150):
    force = rng.normal(size=line.points.shape)
    if comm.rank:
        force = np.full_like(force, np.nan)     # the force of rank 0 counts
    body.advance(force)
    bent.advance(force)
    free.advance(force)
    frame.advance(force)
    large.advance(force)
    if step == 99:
        state = body.state()
        if comm.rank:
            state = None                        # the state of rank 0 counts
        other = ElasticStructure(
            tube, material=material, time_step=4e-5, damping=damping, loads=loads, element="standard")
        other.restore(state)
        body, before = other, body
        np.testing.assert_array_equal(body.boundary_acceleration, before.boundary_acceleration)
    if step == 120:
        out["predicted"] = body.predict(1e-3)
for name, one in (("body", body), ("bent", bent), ("free", free), ("frame", frame), ("large", large)):
    out |= {name + "_" + key: getattr(one, "boundary_" + key)
            for key in ("displacement", "velocity", "acceleration")}
    out[name + "_response"] = one.acceleration_by(np.cos(line.points))
    out |= {name + "_" + key: np.array(value) for key, value in vars(one.energies()).items()}
    for key in ("centroid", "mean_rotation", "momentum", "external_force"):
        out[name + "_" + key] = np.array(getattr(one, key)())
for name, one in (("body", body), ("bent", bent), ("frame", frame), ("large", large)):
    out |= {name + "_" + key: value for key, value in vars(one.peaks()).items() if value is not None}
    out |= {name + "_field_" + key: value for key, value in one.fields().point_data.items()}
    out[name + "_frequencies"] = one.frequencies(4)
for element in ("standard", "enhanced"):
    out["static_" + element] = ElasticStructure(tube, material=material, time_step=1.0, element=element, loads=[
        BoundaryLoad(boundary="outer", total_force=(1.0, 2.0)),
        BoundaryLoad(boundary="inner", total_force=(-1.0, -2.0))]).static_displacement()
beam = meshes.beam(length=1.0, height=0.05, order=2, cell="triangle")
swing = ElasticStructure(beam, material=material, time_step=1e-4)
out["frequencies"] = swing.frequencies(3)
swing.release_from_mode(1, 1e-3)
for _ in range(50):
    swing.advance(np.zeros_like(beam.outer_polyline.points))
out["swing"] = swing.boundary_displacement
np.savez(f"{sys.argv[1]}_{comm.rank}.npz", **out)
"""


def test_two_ranks_give_the_serial_answer(tmp_path: Path) -> None:
    # An MPI process marks its environment; a new mpirun must not take it for its own.
    marks = ("OMPI_", "PMIX_", "PRTE_", "ORTE_")
    clean = {key: value for key, value in os.environ.items() if not key.startswith(marks)}
    run = [sys.executable, "-c", SCRIPT]
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"]
    subprocess.run([*run, str(tmp_path / "serial")], check=True, env=clean, timeout=300)
    subprocess.run([*mpirun, *run, str(tmp_path / "parallel")], check=True, env=clean, timeout=300)
    serial = np.load(tmp_path / "serial_0.npz")
    ranks = [np.load(tmp_path / f"parallel_{rank}.npz") for rank in range(2)]
    assert len(serial.files) > 100
    # A turned body's places, 0.05 m with their round-off of 1e-17 m, swing in the fastest mode, 5e5 rad/s.
    noisy = dict.fromkeys(("frame_acceleration", "large_acceleration"), 30 * 1e-17 * 5e5**2)
    for name in serial.files:
        scale = np.abs(serial[name]).max()
        allowed = 1e-9 * scale + 1e-15 + noisy.get(name, 0.0)
        for parallel in ranks:
            np.testing.assert_allclose(parallel[name], serial[name], rtol=0, atol=allowed, err_msg=name)
