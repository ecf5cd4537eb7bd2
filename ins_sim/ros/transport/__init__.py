"""Messages between nodes: quality of service, queues, repairs of lost messages, waiting."""
