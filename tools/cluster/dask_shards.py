"""An ensemble over the workers of Dask: python3 dask_shards.py FILE.toml FOLDER SHARDS [SCHEDULER]."""
import subprocess
import sys

from dask.distributed import Client

if __name__ == "__main__":
    file, folder, shards = sys.argv[1:4]
    line = ["hamel", "ensemble", file, "-o", folder, "--quiet"]  # all workers share the folder
    client = Client(sys.argv[4] if len(sys.argv) > 4 else None)
    parts = [line + ["--threads", "1", "--shard", f"{i + 1}/{shards}"] for i in range(int(shards))]
    client.gather(client.map(subprocess.check_call, parts, pure=False))
    sys.exit(subprocess.call(line + ["--merge"]))
