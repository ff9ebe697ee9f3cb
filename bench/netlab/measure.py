#!/usr/bin/python3
"""Round trips and rate of the lab without MPI; for lab1: netlab --mpi none -- measure.py ...

measure.py rtt [COUNT]     ICMP echo to the kernel of lab2: median, 1st and 99th percentile [us]
measure.py rate [MBYTES]   one TCP connection to lab2: payload [Mbit/s]
"""
import os
import socket
import struct
import subprocess
import sys
import time

PEER = "10.77.0.2"
PORT = 5077


def checksum(data):
    total = sum(struct.unpack(f"!{len(data) // 2}H", data))
    total = (total >> 16) + (total & 0xFFFF)
    return ~(total + (total >> 16)) & 0xFFFF


def echo_request(sequence):
    body = b"netlab" * 9 + b"lab!"
    head = struct.pack("!BBHHH", 8, 0, 0, 77, sequence)
    return struct.pack("!BBHHH", 8, 0, checksum(head + body), 77, sequence) + body


def round_trip(link, sequence):
    request = echo_request(sequence)
    start = time.perf_counter()
    link.sendto(request, (PEER, 0))
    while time.perf_counter() - start < 2:
        try:
            reply = link.recv(2000)
        except BlockingIOError:  # polls as a rank does: to be woken is not the network's time
            continue
        now = time.perf_counter()
        if reply[20] == 0 and reply[26:28] == request[6:8]:
            return now - start
    return None


def rtt(count=300):
    link = socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_ICMP)
    link.setblocking(False)
    answers = [round_trip(link, sequence) for sequence in range(count + 5)][5:]
    times = sorted(1e6 * t for t in answers if t is not None)
    if not times:
        sys.exit("measure.py: no answer from lab2")
    at = [times[int(share * (len(times) - 1))] for share in (0.5, 0.01, 0.99)]
    print(f"rtt_us {at[0]:.1f} p1 {at[1]:.1f} p99 {at[2]:.1f} lost {count - len(times)}")


def sink():
    server = socket.create_server(("", PORT))
    print("listening", flush=True)
    link, _ = server.accept()
    received, start = 0, None
    while data := link.recv(1 << 20):
        start = start or time.perf_counter()
        received += len(data)
    print(f"rate_mbit {8e-6 * received / (time.perf_counter() - start):.1f} bytes {received}")


def rate(mbytes=64):
    command = [os.environ["NETLAB_ON"], "lab2", f"exec {os.path.realpath(__file__)} sink"]
    far = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    far.stdout.readline()
    with socket.create_connection((PEER, PORT)) as link:
        block = bytes(1 << 20)
        for _ in range(mbytes):
            link.sendall(block)
    print(far.stdout.readline().strip())


if __name__ == "__main__":
    words = sys.argv[1:]
    actions = {"rtt": rtt, "rate": rate, "sink": sink}
    if not words or words[0] not in actions or not all(word.isdigit() for word in words[1:]):
        sys.exit(__doc__)
    actions[words[0]](*map(int, words[1:]))
