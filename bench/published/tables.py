"""The published figures: 44 Core 2 Duo nodes, Gigabit Ethernet, blocking two-sided messages, all-pairs contact search."""

PROCESSES = [1, 5, 10, 15, 20, 25, 30, 35]
SECONDS = {
    5000: [286.0, 73.97, 47.00, 40.00, 36.00, 34.00, 35.20, 33.70],
    10000: [677.0, 129.80, 70.60, 55.80, 47.50, 43.90, 42.80, 41.70],
}
STEPS = 10000
# Shares of the serial run.
PROFILE = [("contact search", 0.75), ("integration", 0.09), ("force update", 0.09), ("accelerations", 0.02),
           ("positions", 0.02), ("velocities", 0.01)]
DECKS = {5000: "soil_duct.toml", 10000: "soil_duct_10k.toml"}


def speed_up(seconds):
    return [seconds[0] / value for value in seconds]


def efficiency(processes, seconds):
    return [gain / p for p, gain in zip(processes, speed_up(seconds))]
