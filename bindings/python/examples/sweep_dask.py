"""Runs the cases of a study in processes of dask: python sweep_dask.py STUDY RESULTS [PROCESSES].

The file is the one that `sigmastar sweep STUDY -o RESULTS` writes, byte for byte. For a cluster, connect the client to its
scheduler: `Client("tcp://host:8786")`. The workers need the package, and no files.
"""

import os
import sys

import sigmastar
from distributed import Client, LocalCluster


def sweep(path, output, processes=2):
    """Certifies every case in some processes, and writes the results."""
    study = sigmastar.load_study(path)
    # Each process shares its cores among the threads of one case; one thread each, where the cases are many.
    os.environ.setdefault("RAYON_NUM_THREADS", "1")
    with LocalCluster(n_workers=processes, threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            shared = client.scatter(study, broadcast=True)
            lines = client.gather([client.submit(sigmastar.run_case, shared, index) for index in range(study.cases)])
    sigmastar.write_results(study, lines, output)


if __name__ == "__main__":
    sweep(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:4]))
