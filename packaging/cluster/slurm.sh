#!/bin/bash
#SBATCH --job-name=busk-batch
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=16
#SBATCH --mem-per-cpu=2G
#SBATCH --time=04:00:00
# Runs `busk batch` on the nodes of one job: sbatch slurm.sh SCANS --design DESIGN --out RESULTS
# Busk with its extra `batch` lies on a file system that all nodes share; BUSK is its folder. A job that was
# ended goes on where it was when it is submitted again.
set -euo pipefail
BUSK=${BUSK:-$HOME/busk}
python=$BUSK/.venv/bin/python
work=$(mktemp -d "${BUSK_WORK:-$HOME}/busk-job.XXXXXX")
end() {
    kill $(jobs -p) 2>/dev/null || true
    sleep 2
    kill -KILL $(jobs -p) 2>/dev/null || true
    wait 2>/dev/null || true
    rm -rf "$work"
}
trap end EXIT

# Whoever reaches a scheduler can run programs on its workers: only holders of these certificates do.
settings=$("$python" "$BUSK/packaging/cluster/certificates.py" "$work/tls")
while IFS= read -r setting; do export "${setting?}"; done <<<"$settings"

"$python" -m distributed.cli.dask_scheduler --protocol tls --port 0 --no-dashboard \
    --scheduler-file "$work/scheduler.json" >"$work/scheduler.log" 2>&1 &
for _ in $(seq 120); do [ -s "$work/scheduler.json" ] && break; sleep 1; done

# One worker a node; each of its threads has a process that computes bodies.
srun --overlap --kill-on-bad-exit=0 "$python" -m distributed.cli.dask_worker --protocol tls --no-dashboard --no-nanny \
    --nthreads "${SLURM_CPUS_PER_TASK:-1}" --memory-limit 0 --local-directory "${TMPDIR:-/tmp}" \
    --scheduler-file "$work/scheduler.json" >"$work/workers.log" 2>&1 &

address=$("$python" -c 'import json, sys; print(json.load(open(sys.argv[1]))["address"])' "$work/scheduler.json")
"$BUSK/.venv/bin/busk" batch "$@" --scheduler "$address"
