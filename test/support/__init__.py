"""What tests share: settings, flights, bags, node processes, figures."""
