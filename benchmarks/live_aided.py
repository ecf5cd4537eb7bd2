"""
Six nodes in real time, the meter in mode signal: losses, and CPU time of each node.

Run it in an environment with rclpy: python benchmarks/live_aided.py [seconds, by default 600]
"""

import os
import sys
import tempfile
import time

from live_chain import Listener, start, stop
import numpy as np

from ins_sim import graph, resources
from ins_sim.messages import topics

DOMAIN, RATE_HZ = 93, 100
HEARD = {topics.TRUTH_IMU: RATE_HZ, topics.IMU_RAW: RATE_HZ, topics.INS_ODOMETRY: RATE_HZ,
         topics.AIDED_ODOMETRY: RATE_HZ, topics.AIDED_SIGMAS[2]: RATE_HZ, topics.GNSS_FIX: 1}


def main(seconds=600.0):
    """Print the losses of each topic from its first message on, and CPU seconds by node."""
    seconds = float(seconds)
    # GNSS is out in the middle third; a parameter of one node overrides that for all nodes.
    values = {'motion_generator:duration_s': seconds, 'velocity_meter:mode': 'signal',
              'aided_navigator:gnss_model.use': True, 'gnss:outages.start_s': [seconds / 3.0],
              'gnss:outages.end_s': [seconds / 1.5]}
    files = [word for name in ('default', 'route_flight', 'grade_mid')
             for word in ('--params-file', str(resources.config(name)))]
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    listener, nodes, ends = Listener(DOMAIN, heard=HEARD), {}, {}
    with tempfile.TemporaryFile() as log:
        try:
            for process in (*graph.AIDING, *graph.PROCESSES):
                if process.name != graph.MASTER:
                    nodes[process.name] = start(process.executable, values, DOMAIN, files,
                                                stdout=log, stderr=log)
            listener.wait_for(topics.INS_ODOMETRY.name, topics.AIDED_ODOMETRY.name,
                              topics.GNSS_FIX.name)
            began = time.monotonic()
            nodes[graph.MASTER] = generator = start(graph.MASTER, values, DOMAIN, files,
                                                    stdout=log, stderr=log)
            while os.waitid(os.P_PID, generator.pid,
                            os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
                listener.poll()
                time.sleep(0.1)
            took_s = time.monotonic() - began
            time.sleep(3.5)
            listener.poll()
        finally:
            ends = {name: stop(node) for name, node in nodes.items()}
    for topic, rate_hz in HEARD.items():
        stamps = np.array(sorted(listener.stamps(topic)))
        lost = round((seconds - stamps[0] * 1e-9) * rate_hz) + 1 - len(stamps)
        print(f'{topic.name}: {len(stamps)} heard from {stamps[0] * 1e-9:.2f} s on, {lost} lost')
    listener.close()
    print(', '.join(f'{name} {cpu:.0f} s' for name, (_, cpu) in ends.items())
          + f' of CPU in {took_s:.0f} s')


if __name__ == '__main__':
    main(*sys.argv[1:])
