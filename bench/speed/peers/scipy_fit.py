# SPDX-License-Identifier: BSD-3-Clause
"""Minimises 1/2 x'Hx - g'x in a box by SciPy's L-BFGS-B.

    scipy_fit.py FOLDER TOLERANCE

FOLDER/problem.bin: n and the number of entries of H (int64), H by columns (int32 starts [n + 1], int32 rows, float64
values), then g, lower, upper (float64 [n] each). FOLDER/solution.bin: processor seconds of the solver, x. It starts at
x = 0 and ends when the projected gradient is nowhere above TOLERANCE, or where the line search finds no lower value.
"""
import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import sys
import time

import numpy as np
from scipy.optimize import minimize
from scipy.sparse import csr_matrix

folder, tolerance = sys.argv[1], float(sys.argv[2])
with open(os.path.join(folder, "problem.bin"), "rb") as file:
    n, entries = np.fromfile(file, np.int64, 2)
    starts = np.fromfile(file, np.int32, n + 1)
    rows = np.fromfile(file, np.int32, entries)
    values = np.fromfile(file, np.float64, entries)
    linear, lower, upper = (np.fromfile(file, np.float64, n) for _ in range(3))
hessian = csr_matrix((values, rows, starts), shape=(n, n))  # symmetric: rows are columns


def value_and_gradient(x):
    product = hessian @ x
    return 0.5 * (x @ product) - linear @ x, product - linear


bounds = np.column_stack([lower, upper])
begin = time.process_time()
result = minimize(
    value_and_gradient,
    np.zeros(n),
    jac=True,
    method="L-BFGS-B",
    bounds=bounds,
    options={
        "maxcor": 20,
        "ftol": 0,
        "gtol": tolerance,
        "maxiter": 20000,
        "maxfun": 40000,
    },
)
seconds = time.process_time() - begin
with open(os.path.join(folder, "solution.bin"), "wb") as file:
    np.concatenate([[seconds], result.x]).tofile(file)
