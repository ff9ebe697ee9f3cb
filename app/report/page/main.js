// The page of what the data is of.
document.title = data.title + ' – barchan';
document.querySelector('h1').textContent = data.title;
document.querySelector('.sub').textContent = data.about;
if (data.facts) section('summary', 'Summary', table(null, data.facts, 'words'));
if (data.view && data.view.frames.length) particlesSection();
if (data.check) section('check', 'What it makes', make('pre', {tabindex: 0}, data.check));
if (data.series && data.series.rows.length) seriesSection();
if (data.trace && data.trace.slices.length) timelineSection();
if (data.run) { communicationSection(); balanceSection(); choiceSection(); }
if (data.sweep) sweepSections();
if (data.machine) wordsSection('machine', 'Machine', data.machine);
if (data.deck && Object.keys(data.deck).length) wordsSection('deck', 'Deck', data.deck);
document.body.dataset.ready = 'yes';
