"""Runs the cases of a study in processes of dask: python sweep_dask.py STUDY RESULTS [PROCESSES].

The file is the one that `sigmastar sweep STUDY -o RESULTS` writes, byte for byte. For a cluster, connect the client to its
scheduler: `Client("tcp://host:8786")`. The workers need the package, and no files.
"""

import os
import sys
from typing import Any, Dict, List

import sigmastar
from distributed import Client, LocalCluster


def lines(client: Any, study: sigmastar.Study) -> List[str]:
    """The results of all cases, in order."""
    shared = client.scatter(study, broadcast=True)
    made: List[str] = client.gather([client.submit(sigmastar.run_case, shared, index) for index in range(study.cases)])
    return made


def sweep(path: str, output: str, processes: int = 2) -> None:
    """Certifies every case in some processes, and writes the results."""
    study = sigmastar.load_study(path)
    # Each process shares its cores among the threads of one case; one thread each, where the cases are many.
    os.environ.setdefault("RAYON_NUM_THREADS", "1")
    options: Dict[str, Any] = {"threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(n_workers=processes, **options) as cluster:
        with Client(cluster) as client:
            made = lines(client, study)
    sigmastar.write_results(study, made, output)


if __name__ == "__main__":
    sweep(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:4]))
