#!/usr/bin/env python3
"""A compiler launcher that notes what each file takes: processor_time.py LOG COMPILER ARGS..."""
import json
import os
import resource
import subprocess
import sys

log, command = sys.argv[1], sys.argv[2:]
code = subprocess.run(command).returncode
used = resource.getrusage(resource.RUSAGE_CHILDREN)
output = command[command.index("-o") + 1] if "-o" in command else command[-1]
line = json.dumps({"file": output, "seconds": used.ru_utime + used.ru_stime, "megabytes": used.ru_maxrss // 1024}) + "\n"
# One write of a short line: several compilers append at a time.
descriptor = os.open(log, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
os.write(descriptor, line.encode())
os.close(descriptor)
sys.exit(code)
